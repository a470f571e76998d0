// SPDX-License-Identifier: Apache-2.0
// A rig whose tracker is Ultraleap's service. Its pose service loads a stand-in for the library.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "ipc/base/clock.hpp"
#include "tests/services/pose/leapc/fake_leapc.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class RigWithALeap : public SystemTest {
 protected:
  std::string plug() const { return scratch_.path() / "plugged_in"; }
  void plug_in() const { std::ofstream(plug()) << "1"; }
  void unplug() const { std::filesystem::remove(plug()); }
  std::unique_ptr<Command> up_with(Arguments more) const {
    const Variable plugged(test::kFakeLeapPlug, plug());
    more.insert(more.end(), {"--set", std::string("pose.leapc.library=") + FAKE_LEAPC});
    return up(more);
  }
  std::uint64_t samples() const { return status()["rings"]["pose.hands"]["count"]; }
  /// Whether the log of the rig says this within 20 s.
  static bool says(const Command& rig, const std::string& words) {
    const auto until = Deadline::in(20s);
    while (!until.passed()) {
      if (rig.log().find(words) != std::string::npos) return true;
      sleep_until_ns(now_ns() + to_ns(50ms));
    }
    return false;
  }
  void expect_more_samples() const {
    const auto before = samples();
    const auto until = Deadline::in(20s);
    while (samples() < before + 20 && !until.passed()) sleep_until_ns(now_ns() + to_ns(50ms));
    EXPECT_GE(samples(), before + 20);
  }
};

TEST_F(RigWithALeap, PublishesItsHandsAndWaitsForADeviceThatIsUnplugged) {
  plug_in();
  const auto rig = up_with({"--set", "pose.backend=leapc"});
  wait_until_light();
  EXPECT_TRUE(says(*rig, test::kFakeSerial));
  expect_more_samples();
  unplug();
  EXPECT_TRUE(says(*rig, "no device is attached")) << rig->log();
  const auto pid = service("pose")["pid"];
  plug_in();
  expect_more_samples();
  EXPECT_EQ(service("pose")["pid"], pid) << "the service was not restarted";
}

TEST_F(RigWithALeap, TheLandmarksTakeOverWhileItIsUnplugged) {
  plug_in();
  const auto rig = up_with({"--set", "pose.backend=leapc", "--set", "pose.second=none"});
  wait_until_light();
  expect_more_samples();
  unplug();
  EXPECT_TRUE(says(*rig, "the second source is used now")) << rig->log();
  expect_more_samples();
  expect_more_light();
  plug_in();
  EXPECT_TRUE(says(*rig, "the first source is used now")) << rig->log();
  expect_more_samples();
}

TEST_F(RigWithALeap, ALibraryThatHangsEndsItsServiceAndTheRestGoesOn) {
  plug_in();
  const auto rig = up_with({"--set", "pose.backend=leapc"});
  wait_until_light();
  expect_more_samples();
  const auto before = service("pose")["pid"];
  std::ofstream(plug()) << "hangs";
  EXPECT_TRUE(says(*rig, "Ultraleap's library hangs")) << rig->log();
  expect_more_light();
  plug_in();
  expect_more_samples();
  EXPECT_NE(service("pose")["pid"], before);
  std::ofstream(plug()) << "hangs";
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(rig->wait(), 0);
  EXPECT_THAT(traces(), testing::IsEmpty());
}

TEST_F(RigWithALeap, TheLandmarksTakeOverWhileItHangs) {
  plug_in();
  // A service that a busy machine keeps silent is not restarted.
  const auto rig = up_with({"--set", "pose.backend=leapc", "--set", "pose.second=none", "--set",
                            "supervisor.silent_s=10"});
  wait_until_light();
  expect_more_samples();
  std::ofstream(plug()) << "hangs";
  EXPECT_TRUE(says(*rig, "the second source is used now")) << rig->log();
  EXPECT_TRUE(says(*rig, "its software hangs")) << rig->log();
  expect_more_samples();
  plug_in();
  EXPECT_TRUE(says(*rig, "the first source is used now")) << rig->log();
  expect_more_samples();
}

TEST_F(RigWithALeap, CanBeSwappedForAnotherTrackerWhileItRuns) {
  plug_in();
  const auto rig = up_with({});
  wait_until_light();
  const auto swapped = handcast({"swap", "pose", "leapc"});
  EXPECT_EQ(swapped.exit_code, 0) << swapped.output << swapped.log;
  EXPECT_TRUE(says(*rig, test::kFakeSerial)) << rig->log();
  expect_more_samples();
  EXPECT_EQ(handcast({"swap", "pose", "twin"}).exit_code, 0);
  expect_more_light();
}

TEST_F(RigWithALeap, AFrozenTrackerIsInTheStatus) {
  const auto rig = up({"--set", "twin.tracker.frozen_at_s=2", "--set", "twin.tracker.frozen_s=1",
                       "--set", "twin.motion=builtin:wave"});
  EXPECT_TRUE(says(*rig, "it has frozen")) << rig->log();
  EXPECT_GE(status()["tracker_faults"]["frozen"].get<int>(), 1);
  EXPECT_THAT(handcast({"status"}).output, HasSubstr("tracker: frozen"));
}

}  // namespace
}  // namespace handcast::system_test
