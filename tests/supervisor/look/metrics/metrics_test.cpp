// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/metrics/metrics.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>

#include <array>
#include <vector>

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
  look.figures->lights["projector"] = {"window system", 7, 5};
  look.figures->lights["projector2"] = {"kernel", 9, 1};
  const auto text = metrics_text(look);
  EXPECT_THAT(text,
              HasSubstr(R"(handcast_light_times_info{service="projector",by="window system"} 1)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_light_missed_refreshes_total{service="projector"} 7)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_light_missed_refreshes_total{service="projector2"} 9)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_light_doubled_frames_total{service="projector"} 5)"));
}

TEST(Metrics, ARingHasTheRateThatTheRigFileAsksFor) {
  auto look = look_at(10);
  look.figures->streams["projection.frames"].wanted_hz = 60;
  EXPECT_THAT(metrics_text(look),
              HasSubstr(R"(handcast_ring_wanted_hertz{ring="projection.frames"} 60)"));
}

TEST(Metrics, LostImagesAreCountedByReason) {
  auto look = look_at(10);
  look.figures->lost_images = {{"missing", 3}, {"skipped", 2}};
  const auto text = metrics_text(look);
  EXPECT_THAT(text, HasSubstr(R"(handcast_camera_lost_images_total{reason="missing"} 3)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_camera_lost_images_total{reason="skipped"} 2)"));
}

TEST(Metrics, FaultsOfTheTrackerAreCountedByKind) {
  auto look = look_at(10);
  EXPECT_THAT(metrics_text(look), Not(HasSubstr("handcast_tracker_faults")));
  look.figures->tracker_faults = {{"frozen", 3}, {"exchanged", 0}};
  const auto text = metrics_text(look);
  EXPECT_THAT(text, HasSubstr(R"(handcast_tracker_faults_total{kind="frozen"} 3)"));
  EXPECT_THAT(text, HasSubstr(R"(handcast_tracker_faults_total{kind="exchanged"} 0)"));
}

TEST(Metrics, TheDriftOfTheTrackerIsThereOnceItIsKnown) {
  auto look = look_at(10);
  EXPECT_THAT(metrics_text(look), Not(HasSubstr("handcast_tracker")));
  look.figures->tracker_drift = DriftFigures{true, 9, 5.5, 0.25};
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
  look.figures.reset();
  EXPECT_THAT(metrics_text(look), HasSubstr("handcast_supervisor_up 0"));
}

UniqueFd connected(int port) {
  UniqueFd client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const sockaddr_in address{.sin_family = AF_INET,
                            .sin_port = htons(static_cast<std::uint16_t>(port)),
                            .sin_addr = {htonl(INADDR_LOOPBACK)},
                            .sin_zero = {}};
  EXPECT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address),
            0);
  return client;
}

/// Everything that the server answers to a request until it closes the connection.
std::string answer_to(int port, std::string_view request) {
  const auto client = connected(port);
  ::send(client.get(), request.data(), request.size(), MSG_NOSIGNAL);
  std::string text;
  std::array<char, 4096> bytes;
  for (;;) {
    const auto count = ::recv(client.get(), bytes.data(), bytes.size(), 0);
    if (count <= 0) return text;
    text.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

TEST(MetricsServer, AScrapeGetsTheMetricsOfThatMoment) {
  double count = 0;
  const auto server = MetricsServer::open(0, [&] { return look_at(++count); });
  ASSERT_TRUE(server) << server.error().what;
  const auto answer = answer_to(server->port(), "GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_THAT(answer, AllOf(testing::StartsWith("HTTP/1.1 200 OK\r\n"), HasSubstr("text/plain"),
                            HasSubstr(R"(handcast_rig_info{rig="paper"} 1)")));
  EXPECT_THAT(answer_to(server->port(), "GET / HTTP/1.1\r\nHost: x\r\n\r\n"),
              testing::StartsWith("HTTP/1.1 404"));
  EXPECT_EQ(count, 1);
}

TEST(MetricsServer, ClientsThatSayNothingAreLeft) {
  const auto server = MetricsServer::open(0, [] { return look_at(1); });
  ASSERT_TRUE(server) << server.error().what;
  std::vector<UniqueFd> silent;
  for (int i = 0; i < MetricsServer::kThreads; ++i) silent.push_back(connected(server->port()));
  EXPECT_THAT(answer_to(server->port(), "GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n"),
              HasSubstr("handcast_rig_info"));
}

TEST(MetricsServer, APortThatIsTakenIsForAPersonToChange) {
  const auto first = MetricsServer::open(0, [] { return look_at(1); });
  ASSERT_TRUE(first) << first.error().what;
  const auto second = MetricsServer::open(first->port(), [] { return look_at(1); });
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::bad_config);
  EXPECT_THAT(second.error().what, HasSubstr("supervisor.metrics_port"));
}

}  // namespace
}  // namespace handcast::supervisor
