// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "services/lab/simulate/score.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

namespace handcast::simulate {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(CanBeScored, ASensorThatDoesNotSeeTheTwinsHandIsRefusedWithWhatToAdd) {
  for (const auto& [chosen, remedy] :
       {std::pair{"pose.backend=leapc", "--set pose.backend=twin"},
        std::pair{"pose.backend=replay", "--set pose.backend=twin"},
        std::pair{"pose.second=none", "--set pose.second="},
        std::pair{"camera.backend=v4l2", "--set camera.backend=twin"},
        std::pair{"landmarks.backend=replay", "--set landmarks.backend=twin"},
        std::pair{"pose.backend=external", "--poses FILE"},
        std::pair{"landmarks.backend=external", "--landmarks FILE"}}) {
    Options options = options_of("twin", 0.05);
    add_settings(options, {chosen});
    const auto done = run(options);
    ASSERT_FALSE(done) << chosen;
    EXPECT_EQ(done.error().code, Errc::bad_config);
    EXPECT_THAT(done.error().what,
                AllOf(HasSubstr("cannot be scored"), HasSubstr(remedy), Not(HasSubstr("\n"))));
  }
}

TEST(CanBeScored, ASensorWhoseResultsAreInAFileMayBeAny) {
  Options options;
  options.poses_file = "poses.csv";
  EXPECT_TRUE(check_can_be_scored(rig_with({"pose.backend=leapc", "pose.second=none"}), options));
  EXPECT_FALSE(check_can_be_scored(rig_with({"landmarks.backend=external"}), options));
  options.landmarks_file = "landmarks.csv";
  EXPECT_TRUE(check_can_be_scored(rig_with({"landmarks.backend=external"}), options));
  EXPECT_FALSE(check_can_be_scored(rig_with({"camera.backend=v4l2"}), options));
}

TEST(CanBeScored, EachRigSaysAllThatIsToBeChanged) {
  const auto replay = config::load_rig(source_root() / "config/rigs/replay.toml");
  ASSERT_TRUE(replay);
  const auto refused = check_can_be_scored(*replay);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what,
              HasSubstr("add --set camera.backend=twin --set landmarks.backend=twin --set "
                        "pose.backend=twin"));
}

TEST(CanBeScored, PosesFromLandmarksOfTheTwinsCamerasAre) {
  for (const auto* backend : {"pose.backend=none", "pose.backend=stereo"})
    EXPECT_TRUE(check_can_be_scored(rig_with({backend}))) << backend;
  const auto webcam = check_can_be_scored(
      rig_with({"pose.backend=stereo", "camera2.backend=v4l2", "landmarks2.backend=replay"}));
  ASSERT_FALSE(webcam);
  EXPECT_THAT(webcam.error().what,
              HasSubstr("--set camera2.backend=twin --set landmarks2.backend=twin"));
  EXPECT_TRUE(check_can_be_scored(rig_with({"camera2.backend=v4l2"}))) << "not used";
}

}  // namespace
}  // namespace handcast::simulate
