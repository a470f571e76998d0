// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/metrics/metrics.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>

#include "ipc/base/unique_fd.hpp"
#include "tests/supervisor/look/top/rig_looks.hpp"

namespace handcast::supervisor {
namespace {

using test::look_at;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Metrics, AreNamedAsPrometheusWants) {
  const auto text = metrics_text(look_at(10));
  EXPECT_THAT(text, HasSubstr("# HELP handcast_ring_messages_total Messages"));
  EXPECT_THAT(text, HasSubstr("# TYPE handcast_ring_messages_total counter"));
  EXPECT_THAT(text, HasSubstr("# TYPE handcast_ring_newest_age_seconds gauge"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_rig_info{rig="paper"} 1)"));
}

TEST(Metrics, ServicesHaveTheirStatesAndWhatTheyUse) {
  const auto text = metrics_text(look_at(10));
  EXPECT_THAT(text, AllOf(HasSubstr(R"(handcast_service_up{service="camera"} 1)"),
                          HasSubstr(R"(handcast_service_up{service="projector"} 0)")));
  EXPECT_THAT(text, HasSubstr(R"(handcast_service_state{service="projector",state="degraded"} 1)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_service_state{service="projector",state="ready"} 0)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_service_restarts_total{service="projector"} 12)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_service_cpu_seconds_total{service="camera"} 2.5)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_service_resident_bytes{service="camera"} 50331648)"));
}

TEST(Metrics, RingsAndReadersHaveTheirCounts) {
  const auto text = metrics_text(look_at(10));
  EXPECT_THAT(text, HasSubstr(R"(handcast_ring_messages_total{ring="camera.frames"} 2400)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_ring_dropped_total{ring="camera.frames"} 0)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_ring_newest_age_seconds{ring="camera.frames"} 0.002)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_ring_epoch{ring="camera.frames"} 3)"));
  EXPECT_THAT(
      text,
      HasSubstr(
          R"(handcast_reader_received_total{ring="camera.frames",reader="projector",row="0"} 1200)"));
  EXPECT_THAT(
      text,
      HasSubstr(
          R"(handcast_reader_skipped_total{ring="camera.frames",reader="projector",row="0"} 1200)"));
  EXPECT_THAT(
      text,
      HasSubstr(
          R"(handcast_reader_lag_messages{ring="camera.frames",reader="projector",row="0"} 1)"));
  EXPECT_THAT(text, Not(HasSubstr(R"(handcast_ring_newest_age_seconds{ring="marks.camera"})")))
      << "nothing was published: no age";
}

TEST(Metrics, TheLightSaysWhoKnowsItsTimesAndWhatTheOutputMissed) {
  auto look = look_at(10);
  EXPECT_THAT(metrics_text(look), Not(HasSubstr("handcast_light"))) << "none came";
  look.status["light"] = {
      {"times_by", "window system"}, {"missed_refreshes", 7}, {"doubled_frames", 5}};
  look.status["rings"]["projection.frames"] = {{"wanted_hz", 60}};
  const auto text = metrics_text(look);
  EXPECT_THAT(text, HasSubstr(R"(handcast_light_times_info{by="window system"} 1)"));
  EXPECT_THAT(text, HasSubstr("handcast_light_missed_refreshes_total 7"));
  EXPECT_THAT(text, HasSubstr("handcast_light_doubled_frames_total 5"));
  EXPECT_THAT(text, HasSubstr("handcast_light_wanted_hertz 60"));
}

TEST(Metrics, LostImagesAreCountedByReason) {
  auto look = look_at(10);
  look.status["lost_images"] = {{"missing", 3}, {"skipped", 2}};
  const auto text = metrics_text(look);
  EXPECT_THAT(text, HasSubstr(R"(handcast_camera_lost_images_total{reason="missing"} 3)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_camera_lost_images_total{reason="skipped"} 2)"));
}

TEST(Metrics, FaultsOfTheTrackerAreCountedByKind) {
  auto look = look_at(10);
  EXPECT_THAT(metrics_text(look), Not(HasSubstr("handcast_tracker_faults")));
  look.status["tracker_faults"] = {{"frozen", 3}, {"exchanged", 0}};
  const auto text = metrics_text(look);
  EXPECT_THAT(text, HasSubstr(R"(handcast_tracker_faults_total{kind="frozen"} 3)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_tracker_faults_total{kind="exchanged"} 0)"));
}

TEST(Metrics, TheDriftOfTheTrackerIsThereOnceItIsKnown) {
  auto look = look_at(10);
  EXPECT_THAT(metrics_text(look), Not(HasSubstr("handcast_tracker")));
  look.status["tracker_drift"] = {
      {"moved", true}, {"places", 9}, {"across_mm", 5.5}, {"turn_deg", 0.25}};
  const auto text = metrics_text(look);
  EXPECT_THAT(text, HasSubstr("handcast_tracker_moved 1"));
  EXPECT_THAT(text, HasSubstr("handcast_tracker_drift_millimetres 5.5"));
  EXPECT_THAT(text, HasSubstr("handcast_tracker_drift_degrees 0.25"));
}

TEST(Metrics, StagesAreInSeconds) {
  const auto text = metrics_text(look_at(10));
  EXPECT_THAT(text, HasSubstr(R"(handcast_stage_seconds{stage="draw",quantile="0.5"} 0.0015)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_stage_seconds{stage="draw",quantile="0.99"} 0.0025)"));
}

TEST(Metrics, OfADeadSupervisorTellThatAndGoOnWithTheRings) {
  auto look = look_at(10);
  EXPECT_THAT(metrics_text(look), HasSubstr("handcast_supervisor_up 1"));
  look.missing = "nobody answers";
  EXPECT_THAT(metrics_text(look), AllOf(HasSubstr("handcast_supervisor_up 0"),
                                        HasSubstr("handcast_ring_messages_total")));
  look.status = nullptr;
  EXPECT_THAT(metrics_text(look), HasSubstr("handcast_supervisor_up 0"));
}

TEST(Metrics, APortThatIsTakenIsForAPersonToChange) {
  const UniqueFd taken(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{.sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(INADDR_LOOPBACK)}};
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(taken.get(), reinterpret_cast<const sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(taken.get(), 1), 0);
  ASSERT_EQ(getsockname(taken.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  const auto server = serve_metrics(ntohs(address.sin_port), [] { return look_at(1); });
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error().code, Errc::bad_config);
  EXPECT_THAT(server.error().what, HasSubstr("supervisor.metrics_port"));
}

}  // namespace
}  // namespace handcast::supervisor
