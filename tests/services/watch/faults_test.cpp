// SPDX-License-Identifier: Apache-2.0
#include "services/watch/faults.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/services/watch/a_day.hpp"

namespace handcast::watch {
namespace {

using test::at_s;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::Pair;

class FaultFinderTest : public testing::Test {
 protected:
  RigStatus status() const {
    RigStatus status;
    for (const auto* name : {"camera", "pose", "projector"}) status.services[name].state = "ready";
    return status;
  }
  FaultFinder finder_{{.silent_s = 10, .disk_gb = 2}};
};

TEST_F(FaultFinderTest, ARigThatIsWellHasNone) {
  for (int second = 0; second < 100; ++second) {
    auto well = status();
    well.messages = {{"camera.frames", second}, {"pose.hands", second}};
    EXPECT_THAT(finder_.find(well, {.disk_free_gb = 100, .now_ns = at_s(second)}), IsEmpty());
  }
}

TEST_F(FaultFinderTest, AServiceThatWasGivenUpIsNamedWithItsReason) {
  auto ill = status();
  ill.services["camera"] = {.state = "failed", .reason = "no camera 'A-2134'"};
  EXPECT_THAT(finder_.find(ill, {.disk_free_gb = 100, .now_ns = at_s(1)}),
              Contains(Pair("service camera", HasSubstr("given up: no camera 'A-2134'"))));
  ill.services["camera"] = {.state = "degraded", .reason = "signal 11"};
  EXPECT_THAT(finder_.find(ill, {.disk_free_gb = 100, .now_ns = at_s(2)}),
              Contains(Pair("service camera", HasSubstr("again and again: signal 11"))));
}

TEST_F(FaultFinderTest, OneThatDiesEveryMinuteIsAFaultAndOneThatDiesEveryHourIsNot) {
  auto rig = status();
  bool was_found = false;
  for (int minute = 0; minute < 6; ++minute) {
    rig.services["pose"].restarts = minute;
    was_found = finder_.find(rig, {.disk_free_gb = 100, .now_ns = at_s(60 * minute)})
                    .contains("service pose");
    EXPECT_EQ(was_found, minute == 5) << minute;
  }
  FaultFinder patient({});
  for (int hour = 0; hour < 24; ++hour) {
    rig.services["pose"].restarts = hour;
    EXPECT_THAT(patient.find(rig, {.disk_free_gb = 100, .now_ns = at_s(3600 * hour)}), IsEmpty());
  }
}

TEST_F(FaultFinderTest, RestartsBeforeTheWatchDoNotCount) {
  auto rig = status();
  rig.services["pose"].restarts = 50;
  EXPECT_THAT(finder_.find(rig, {.disk_free_gb = 100, .now_ns = at_s(1)}), IsEmpty());
}

TEST_F(FaultFinderTest, ASensorThatIsSilentForItsTimeIsAFaultUntilItSends) {
  auto rig = status();
  rig.messages = {{"pose.hands", 7}};
  EXPECT_THAT(finder_.find(rig, {.disk_free_gb = 100, .now_ns = at_s(0)}), IsEmpty());
  EXPECT_THAT(finder_.find(rig, {.disk_free_gb = 100, .now_ns = at_s(9.9)}), IsEmpty());
  EXPECT_THAT(finder_.find(rig, {.disk_free_gb = 100, .now_ns = at_s(10)}),
              Contains(Pair("silent pose.hands", HasSubstr("the tracker has sent no sample"))));
  rig.messages = {{"pose.hands", 8}};
  EXPECT_THAT(finder_.find(rig, {.disk_free_gb = 100, .now_ns = at_s(11)}), IsEmpty());
}

TEST_F(FaultFinderTest, AServiceThatIsStartedIsNotSilent) {
  auto rig = status();
  rig.services["pose"].state = "starting";
  rig.messages = {{"pose.hands", 0}};
  for (int second = 0; second < 100; ++second)
    EXPECT_THAT(finder_.find(rig, {.disk_free_gb = 100, .now_ns = at_s(second)}), IsEmpty());
}

TEST_F(FaultFinderTest, AProjectorWithoutFramesIsAFault) {
  auto rig = status();
  rig.messages = {{"projection.frames", 7}};
  finder_.find(rig, {.disk_free_gb = 100, .now_ns = at_s(0)});
  EXPECT_THAT(finder_.find(rig, {.disk_free_gb = 100, .now_ns = at_s(20)}),
              Contains(Key("silent projection.frames")));
}

TEST_F(FaultFinderTest, WhatIsSwitchedOffForTheNightMayBeSilentAndHasItsTimeInTheMorning) {
  auto rig = status();
  rig.messages = {{"projection.frames", 7}};
  const auto silent = [&](double second, bool is_switched_off) {
    return finder_.find(rig, {100, is_switched_off, at_s(second)})
        .contains("silent projection.frames");
  };
  for (int second = 0; second < 100; ++second) EXPECT_FALSE(silent(second, true));
  EXPECT_FALSE(silent(105, false));
  EXPECT_TRUE(silent(110, false));
}

TEST_F(FaultFinderTest, ADiskThatIsNearlyFullIsAFault) {
  EXPECT_THAT(finder_.find(status(), {.disk_free_gb = 1.9, .now_ns = at_s(1)}),
              Contains(Pair("disk", HasSubstr("1.9 GB"))));
}

TEST_F(FaultFinderTest, ASupervisorThatDoesNotAnswerForLongIsAFault) {
  finder_.find(status(), {.disk_free_gb = 100, .now_ns = at_s(100)});
  EXPECT_THAT(finder_.find_without_status(at_s(120)), IsEmpty());
  EXPECT_THAT(finder_.find_without_status(at_s(140)), Contains(Key("supervisor")));
  finder_.find(status(), {.disk_free_gb = 100, .now_ns = at_s(141)});
  EXPECT_THAT(finder_.find_without_status(at_s(142)), IsEmpty());
}

TEST(RigStatus, IsReadFromTheAnswerOfTheSupervisor) {
  const auto status = status_in(nlohmann::json::parse(R"({
      "services": {"pose": {"state": "ready", "restarts": 3, "last_exit": "exit 111", "uptime_s": 5},
                   "dlp": {"state": "failed", "reason": "no controller", "last_exit": "exit 100"}},
      "rings": {"pose.hands": {"count": 12}},
      "tracker_drift": {"moved": true, "across_mm": 4.5, "turn_deg": 1}})"));
  EXPECT_EQ(status.services.at("pose").restarts, 3);
  EXPECT_EQ(status.services.at("pose").reason, "exit 111");
  EXPECT_EQ(status.services.at("dlp").reason, "no controller");
  EXPECT_EQ(status.messages.at("pose.hands"), 12u);
  EXPECT_TRUE(status.drift->moved);
  EXPECT_EQ(status.drift->across_mm, 4.5);
}

TEST(RigStatus, WhatHasAnotherTypeIsLeftOut) {
  for (const auto* odd : {"null", "[]", "{}", R"({"services": 3, "rings": null})",
                          R"({"services": {"pose": 1}, "tracker_drift": {"moved": 7}})"})
    EXPECT_FALSE(status_in(nlohmann::json::parse(odd)).services.contains("camera")) << odd;
}

}  // namespace
}  // namespace handcast::watch
