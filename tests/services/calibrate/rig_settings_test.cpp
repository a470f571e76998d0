// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/rig_settings.hpp"

#include <gmock/gmock.h>

#include "tests/scratch.hpp"

namespace handcast::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

class RigSettings : public testing::Test {
 protected:
  RigSettings() { options_.folder = scratch_.path() / "rig.calibration"; }

  test::Scratch scratch_;
  Options options_;
  config::Rig rig_;
};

TEST_F(RigSettings, TheTwinRunsWithTheReferenceRig) {
  rig_.camera.backend = "twin";
  const auto running = rig_as_it_runs(options_, rig_);
  ASSERT_TRUE(running) << running.error().what;
  EXPECT_EQ(running->calibration.id, calib::load_calibration("")->id);
}

TEST_F(RigSettings, ARealRigWithoutACalibrationNeedsItsSizes) {
  rig_.camera.backend = "v4l2";
  const auto running = rig_as_it_runs(options_, rig_);
  ASSERT_FALSE(running);
  EXPECT_THAT(running.error().what, HasSubstr("--camera 1280x1024 --projector 1920x1080"));
}

TEST_F(RigSettings, WithSizesItRunsWithACalibrationThatTheServicesAccept) {
  rig_.camera.backend = "v4l2";
  options_.camera = {1280, 1024};
  options_.projector = {1920, 1080};
  const auto running = rig_as_it_runs(options_, rig_);
  ASSERT_TRUE(running) << running.error().what;
  const auto file = options_.folder / "rough.toml";
  EXPECT_THAT(running->settings, Contains("calibration=" + file.string()));
  const auto rough = calib::load_calibration(file);
  ASSERT_TRUE(rough) << rough.error().what;
  EXPECT_EQ(rough->camera.width_px, 1280);
  EXPECT_EQ(rough->projector_height_px, 1080);
  EXPECT_LT(glm::distance(rough->to_projector({639.5, 511.5}), {959.5, 539.5}), 1e-6);
}

TEST_F(RigSettings, TheTwinShowsWhatAStepNeeds) {
  const auto settings = twin_scene(Step::screen, calib::Board{});
  EXPECT_THAT(settings, Contains("twin.prop.board=charuco:11x8:20"));
  EXPECT_THAT(settings, Contains("twin.image.leak=1"));
  EXPECT_THAT(twin_scene(Step::tracker, calib::Board{}),
              testing::Not(Contains(HasSubstr("twin.prop"))));
}

}  // namespace
}  // namespace handcast::calibrate
