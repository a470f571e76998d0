// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/check_steps.hpp"

#include <gmock/gmock.h>

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string refusal_of(const Options& options, const std::string& pose_backend) {
  config::Rig rig;
  rig.pose.backend = pose_backend;
  const auto checked = check_steps(options, rig);
  return checked ? "" : checked.error().what;
}

TEST(CheckSteps, ATrackerThatTheRigHasNotIsNotMeasured) {
  Options tracker, correct, reflector;
  tracker.steps = {Step::screen, Step::tracker};
  correct.correct = true;
  reflector.reflector_mm = 8;
  for (const auto& [options, asked] :
       {std::pair(tracker, "tracker: "), {correct, "--correct: "}, {reflector, "--reflector: "}}) {
    EXPECT_THAT(refusal_of(options, "stereo"), HasSubstr(asked));
    EXPECT_THAT(refusal_of(options, "stereo"), HasSubstr("measure `pair` (and `screen`) again"));
    EXPECT_THAT(refusal_of(options, "none"), HasSubstr("no tracker to measure"));
    EXPECT_THAT(refusal_of(options, "none"), Not(HasSubstr("pair")));
    EXPECT_EQ(refusal_of(options, "twin"), "");
  }
}

TEST(CheckSteps, ASecondCameraThatTheRigHasNotIsNotMeasured) {
  Options options;
  options.steps = {Step::pair};
  EXPECT_THAT(refusal_of(options, "twin"), HasSubstr("pair: the rig has no second camera"));
  EXPECT_EQ(refusal_of(options, "stereo"), "");
  Options size;
  size.camera2 = {640, 480};
  EXPECT_THAT(refusal_of(size, "twin"), HasSubstr("--camera2: the rig has no second camera"));
  EXPECT_EQ(refusal_of(size, "stereo"), "");
}

TEST(CheckSteps, NothingIsComparedWithoutACalibration) {
  config::Rig rig;
  rig.camera.backend = "v4l2";
  Options options;
  options.rig_file = "rig.toml";
  EXPECT_TRUE(check_steps(options, rig));
  options.check = true;
  const auto checked = check_steps(options, rig);
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().what,
              HasSubstr("--check needs a calibration, and the rig names none; "
                        "measure one first: handcast calibrate rig.toml"));
  rig.calibration = "own.toml";
  EXPECT_TRUE(check_steps(options, rig));
}

}  // namespace
}  // namespace handcast::calibrate
