// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "supervisor/look/figures/figures.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

json service(const json& more) {
  json status{{"state", "ready"},  {"pid", 42},         {"backend", "twin"},
              {"uptime_s", 3},     {"restarts", 0},     {"last_exit", nullptr},
              {"reason", nullptr}, {"retry_s", nullptr}};
  status.update(more);
  return status;
}

json status_with(const json& more) {
  json status{{"rig", "desk"},
              {"uptime_s", 7},
              {"services", json::object()},
              {"rings", json::object()},
              {"stage_us", json::object()}};
  status.update(more);
  return status;
}

std::string text_of(const json& status) { return print_status(figures_in(status)); }

std::string print_with(const json& pose) {
  return text_of(status_with({{"services", {{"pose", pose}}}}));
}

TEST(StatusText, AServiceThatIsWellHasOneLine) {
  EXPECT_THAT(print_with(service(json::object())), Not(HasSubstr("tried again")));
}

TEST(StatusText, ABackEndInPlaceOfAnotherIsToldWithIt) {
  EXPECT_THAT(print_with(service({{"backend", "twin"}, {"instead_of", "mediapipe"}})),
              HasSubstr("\n  in place of 'mediapipe', a file of which is missing\n"));
  EXPECT_THAT(print_with(service({{"instead_of", nullptr}})), Not(HasSubstr("in place of")));
}

TEST(StatusText, SaysWhoKnowsWhenLightComes) {
  const auto light = [](const char* times_by, int missed) {
    return json{{"times_by", times_by}, {"missed_refreshes", missed}, {"doubled_frames", 2}};
  };
  auto status = status_with(
      {{"light",
        {{"projector", light("kernel", 12345678)}, {"projector2", light("settings", 4)}}}});
  EXPECT_THAT(
      text_of(status),
      HasSubstr("light of projector: 12345678 refreshes without a new frame, 2 frames shown "
                "for several refreshes; times by the kernel\n"));
  EXPECT_THAT(text_of(status), HasSubstr("light of projector2: 4 refreshes"));
  status["light"] = json::object();
  EXPECT_THAT(text_of(status), Not(HasSubstr("light of")));
}

TEST(StatusText, SaysWhatMadeTheSlowestFramesSlow) {
  auto status = status_with({{"slow_frames",
                              {{"projector",
                                {{"count", 100},
                                 {"least_us", 1900.5},
                                 {"preempted", 60},
                                 {"interrupted", 20},
                                 {"page_faults", 5},
                                 {"own", 15}}}}}});
  EXPECT_THAT(
      text_of(status),
      HasSubstr(
          "slowest 100 frames of projector, 1.90 ms or more: 60 preempted by other threads, 20 "
          "interrupted, 5 with page faults, 15 slow by themselves\n"));
  status["slow_frames"] = json::object();
  EXPECT_THAT(text_of(status), Not(HasSubstr("slowest")));
}

TEST(StatusText, NamesTheRingsThatDoNotHoldTheirRate) {
  const auto ring = [](const json& wanted, double held) {
    return json{{"wanted_hz", wanted}, {"held_hz", held},    {"is_held_to_it", true},
                {"is_settled", true},  {"newest_age_ms", 1}, {"count", 9}};
  };
  auto status = status_with({{"rings",
                              {{"camera.frames", ring(525, 172)},
                               {"landmarks.hands", ring(nullptr, 3)},
                               {"pose.hands", ring(110, 100)},
                               {"projection.frames", ring(946, 195)}}}});
  EXPECT_THAT(text_of(status),
              HasSubstr("slow: camera.frames, projection.frames hold less than 90 % of the wanted "
                        "rate; `handcast latency` shows where the time goes"));
  status["rings"]["camera.frames"]["is_held_to_it"] = false;
  EXPECT_THAT(text_of(status), HasSubstr("slow: projection.frames holds less"));
  status["rings"]["projection.frames"]["is_settled"] = false;
  EXPECT_THAT(text_of(status), Not(HasSubstr("slow:"))) << "a service that has just started";
}

TEST(StatusText, TimesOfAMillisecondAndMoreAreInMilliseconds) {
  const auto text = text_of(
      status_with({{"stage_us", {{"draw", {{"p50", 652.6}, {"p99", 9348.15}, {"count", 7}}}}}}));
  EXPECT_THAT(text, AllOf(HasSubstr(" 652.6 us "), HasSubstr(" 9.35 ms "), Not(HasSubstr("9348"))));
}

TEST(StatusText, SaysWhatTheCameraLostAndNothingIfItLostNothing) {
  auto status = status_with(
      {{"lost_images",
        {{"missing", 3}, {"incomplete", 2}, {"underrun", 1}, {"skipped", 5000000000}}}});
  EXPECT_THAT(
      text_of(status),
      HasSubstr("camera: 3 images never arrived, 2 were incomplete, 1 found no free buffer, "
                "5000000000 were skipped for a newer one\n"));
  status["lost_images"] = {{"missing", 0}, {"incomplete", 0}, {"underrun", 0}, {"skipped", 0}};
  EXPECT_THAT(text_of(status), Not(HasSubstr("camera:")));
}

TEST(StatusText, SaysWhatTheTrackerDidWrongAndNothingIfItDidNothing) {
  auto status = status_with({{"tracker_faults", {{"frozen", 1u}, {"jumped", 12u}, {"late", 0u}}}});
  EXPECT_THAT(text_of(status), HasSubstr("tracker: frozen 1 time, jumped 12 times\n"));
  status["tracker_faults"] = {{"frozen", 0u}, {"jumped", "?"}};
  EXPECT_THAT(text_of(status), Not(HasSubstr("tracker:")));
}

TEST(StatusText, SaysWhetherTheTrackerIsWhereTheCalibrationSays) {
  auto status = status_with({{"tracker_drift", nullptr}});
  EXPECT_THAT(text_of(status), Not(HasSubstr("tracker:")));
  status["tracker_drift"] = {
      {"moved", false}, {"places", 9}, {"across_mm", 0.8}, {"turn_deg", 0.21}};
  EXPECT_THAT(text_of(status), HasSubstr("tracker: where the calibration says, as far as 9 "
                                         "places of still hands tell (0.8 mm and 0.21"));
  status["tracker_drift"]["moved"] = true;
  EXPECT_THAT(text_of(status),
              AllOf(HasSubstr("it has moved by 0.8 mm and 0.21 degrees"), HasSubstr("--correct")));
}

TEST(StatusText, SaysHowWellTheClockOfAnotherComputerIsKnown) {
  auto status = status_with({{"bridge", nullptr}});
  EXPECT_THAT(text_of(status), Not(HasSubstr("bridge:")));
  status["bridge"] = {{"clock_error_us", 84.5}, {"refused", 7}};
  EXPECT_THAT(text_of(status),
              HasSubstr("bridge: times of the other computer are known to 0.085 ms; "
                        "7 messages were not used"));
}

TEST(StatusText, OneThatDiesTooOftenSaysWhyHowItEndedWhenItIsTriedAgainAndItsLastWords) {
  const auto text = print_with(service({{"state", "degraded"},
                                        {"last_exit", "exit 111"},
                                        {"reason", "died 10 times within 60 s"},
                                        {"retry_s", 4.2},
                                        {"log", {"the tracker does not answer"}}}));
  EXPECT_THAT(text, AllOf(HasSubstr("degraded"), HasSubstr("exit 111"),
                          HasSubstr("died 10 times within 60 s; tried again in 4.2 s"),
                          HasSubstr("the tracker does not answer")));
}

}  // namespace
}  // namespace handcast::supervisor
