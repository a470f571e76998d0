// SPDX-License-Identifier: Apache-2.0
// A rig whose tracker is an OpenXR runtime: that of the tests, behind the real loader.
#include <gmock/gmock.h>

#include <algorithm>

#include "ipc/client/stream.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/recording/recording_reader.hpp"
#include "tests/services/pose/openxr/runtime/motion.hpp"
#include "tests/services/pose/openxr/scripted_runtime.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class RigWithARuntime : public SystemTest {
 protected:
  RigWithARuntime() {
    // The runtime's tracker sees the twin's hand, which rests, so that any time of it will do.
    config::Rig rig;
    rig.twin.motion = "builtin:still";
    const auto twin = twin::Twin::create(rig, calib::reference_rig());
    if (!twin) throw std::runtime_error(twin.error().what);
    test_runtime::Motion motion{110, {}};
    for (std::uint64_t k = 0; k < 220; ++k)
      motion.frames.push_back((*twin)->tracker_sample(k).poses);
    test_runtime::write_motion(runtime_.in_scratch("motion"), motion);
    play("");
  }
  void play(const std::string& fault) const {
    runtime_.play("motion " + runtime_.in_scratch("motion") + "\n" + fault);
  }
  std::unique_ptr<Command> up_with(const std::string& backend, const Arguments& more = {}) const {
    Arguments all{"--set", "twin.motion=builtin:still",
                  "--set", "pose.backend=" + backend,
                  "--set", "pose.openxr.runtime=" + std::string(HANDCAST_TEST_RUNTIME_MANIFEST)};
    all.insert(all.end(), more.begin(), more.end());
    return up(all);
  }
  std::uint64_t poses() const {
    return status()["rings"]["pose.hands"]["count"].get<std::uint64_t>();
  }
  void expect_more_poses() const {
    const auto before = poses();
    EXPECT_TRUE(eventually([&] { return poses() > before + 20; }));
  }
  bool pose_is(const std::string& state) const { return service("pose")["state"] == state; }

  test::ScriptedRuntime runtime_;
};

TEST_F(RigWithARuntime, ItsHandsAreLitAndTheDoctorSeesThem) {
  const auto rig = up_with("openxr");
  wait_until_light();
  EXPECT_THAT(rig->log(), HasSubstr("Test Runtime 0.1.2, 'Test Tracker'"));
  expect_more_poses();
  const auto outcome =
      handcast({"doctor", "config/rigs/twin.toml", "--seconds", "1", "--json", "--set",
                "pose.backend=openxr", "--set",
                "pose.openxr.runtime=" + std::string(HANDCAST_TEST_RUNTIME_MANIFEST)});
  std::map<std::string, nlohmann::json> findings;
  for (const auto& each : nlohmann::json::parse(outcome.output)) findings[each["check"]] = each;
  EXPECT_EQ(findings["tracker"]["grade"], "good") << outcome.output;
  EXPECT_THAT(findings["tracker"]["sentence"].get<std::string>(), HasSubstr("a hand in 100 %"));
  EXPECT_EQ(findings["tracker software"]["grade"], "good");
  EXPECT_FALSE(findings.contains("tracker service")) << "the rig is using it";
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(RigWithARuntime, AfterALossOfTheRuntimeTheTrackerComesBackWithoutAnyHelp) {
  const auto rig = up_with("openxr");
  wait_until_light();
  const int before = service("pose")["pid"];
  play("refuses\nloses_instance");
  EXPECT_TRUE(
      eventually([&] { return rig->log().find("does its service run?") != std::string::npos; }));
  EXPECT_THAT(rig->log(), HasSubstr("XR_ERROR_INSTANCE_LOST"));
  expect_more_light();
  play("");
  EXPECT_TRUE(eventually([&] { return pose_is("ready") && service("pose")["pid"] != before; }));
  expect_more_poses();
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(RigWithARuntime, ARuntimeThatHangsIsKilledWithItsServiceAndTheRestGoesOn) {
  const auto rig = up_with("openxr");
  wait_until_light();
  const int before = service("pose")["pid"];
  const int camera = service("camera")["pid"];
  play("hangs");
  EXPECT_TRUE(eventually([&] { return service("pose")["pid"] != before; }));
  EXPECT_THAT(rig->log(), HasSubstr("pose has given no sign of life for "));
  expect_more_light();
  play("");
  EXPECT_TRUE(eventually([&] { return pose_is("ready"); }));
  expect_more_poses();
  EXPECT_EQ(service("camera")["pid"], camera);
  play("hangs");
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(rig->wait(), 0);
  EXPECT_THAT(traces(), testing::IsEmpty());
}

TEST_F(RigWithARuntime, ARuntimeThatHangsAtTheStartDoesNotKeepTheRigFromStartingOrStopping) {
  play("hangs_at_start");
  const auto rig = up_with("openxr", {"--set", "supervisor.ready_s=15"});
  EXPECT_TRUE(eventually([&] { return service("projector")["state"] == "ready"; })) << rig->log();
  expect_more_light();
  EXPECT_TRUE(eventually(
      [&] { return rig->log().find("pose was not ready within") != std::string::npos; }));
  play("");
  EXPECT_TRUE(eventually([&] { return pose_is("ready"); })) << rig->log();
  expect_more_poses();
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(RigWithARuntime, WhileItHangsTheSecondSourceIsUsed) {
  // A service that a busy machine keeps silent is not restarted.
  const auto rig =
      up_with("openxr", {"--set", "pose.second=none", "--set", "supervisor.silent_s=10"});
  wait_until_light();
  expect_more_poses();
  const int before = service("pose")["pid"];
  play("hangs");
  EXPECT_TRUE(
      eventually([&] { return rig->log().find("its software hangs") != std::string::npos; }));
  expect_more_poses();
  expect_more_light();
  EXPECT_EQ(service("pose")["pid"], before);
  play("");
  EXPECT_TRUE(eventually(
      [&] { return rig->log().find("the first source is used now") != std::string::npos; }));
  play("hangs");
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(rig->wait(), 0);
  EXPECT_THAT(traces(), testing::IsEmpty());
}

TEST_F(RigWithARuntime, ItReplacesTheTwinsTrackerWhileTheLightGoesOnAndIsRecorded) {
  const auto rig = up_with("twin");
  wait_until_light();
  const auto swapped = handcast({"swap", "pose", "openxr"});
  EXPECT_EQ(swapped.exit_code, 0) << swapped.log;
  EXPECT_EQ(service("pose")["backend"], "openxr");
  expect_more_light();
  expect_more_poses();
  const auto folder = scratch_.path() / "recording";
  const auto recorded = handcast({"record", folder, "--seconds", "2", "--rings", "pose"});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.log;
  auto reader = recording::StreamReader::open<msg::HandPoses>(folder, "pose.hands");
  ASSERT_TRUE(reader) << reader.error().what;
  EXPECT_GT(reader->rows().size(), 50u);
  msg::HandPoses last;
  for (std::size_t i = 0; i < reader->rows().size(); ++i) {
    msg::HandPoses poses;
    ASSERT_TRUE(reader->read(i, poses));
    ASSERT_EQ(poses.count, 1u);
    EXPECT_EQ(poses.hands[0].confidence, 1);
    EXPECT_NE(poses.hands[0].joints[1].position_m, last.hands[0].joints[1].position_m);
    last = poses;
  }
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(RigWithARuntime, ARuntimeThatIsNotThereIsRefusedAndTheOldTrackerGoesOn) {
  play("lacks XR_MND_headless");
  const auto rig = up_with("twin");
  wait_until_light();
  const auto swapped = handcast({"swap", "pose", "openxr"});
  EXPECT_NE(swapped.exit_code, 0);
  EXPECT_THAT(swapped.log, HasSubstr("draws nothing"));
  EXPECT_TRUE(eventually([&] { return service("pose")["backend"] == "twin" && pose_is("ready"); }));
  expect_more_poses();
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

}  // namespace
}  // namespace handcast::system_test
