// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/rig_settings.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "services/tools/calibrate/steps.hpp"
#include "tests/scratch.hpp"

namespace handcast::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

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
  EXPECT_EQ(rough->projector.height_px, 1080);
  EXPECT_LT(glm::distance(rough->projector.pixel_of({639.5, 511.5}), {959.5, 539.5}), 1e-6);
}

TEST_F(RigSettings, ACalibrationOfAnotherCameraLeadsToOneOfItsOwn) {
  auto first = calib::reference_rig();
  first.camera_device = "usb-1.2";
  rig_.calibration = scratch_.path() / "first.toml";
  std::ofstream(rig_.calibration) << calib::print_calibration(first);
  rig_.camera.backend = "v4l2";
  const OwnDevices same{"HD Webcam", "", {"HD Webcam", "usb-1.2"}, {}};
  const auto as_before = rig_as_it_runs(options_, rig_, same);
  ASSERT_TRUE(as_before) << as_before.error().what;
  EXPECT_TRUE(as_before->new_devices.empty()) << "another name of the same camera";

  const OwnDevices other{"Other Cam 2", "", {"Other Cam 2"}, {}};
  const auto refused = rig_as_it_runs(options_, rig_, other);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what,
              HasSubstr("made with the camera 'usb-1.2', and the rig has 'Other Cam 2'"));
  EXPECT_THAT(refused.error().what, HasSubstr("--camera 1280x1024 --projector 1024x768"));

  options_.camera = {640, 480};
  options_.projector = {1024, 768};
  const auto anew = rig_as_it_runs(options_, rig_, other);
  ASSERT_TRUE(anew) << anew.error().what;
  EXPECT_EQ(anew->new_devices, "Other_Cam_2");
  EXPECT_EQ(anew->calibration.camera.width_px, 640);

  const auto greek = rig_as_it_runs(options_, rig_, {"Κάμερα", "", {"Κάμερα"}, {}});
  ASSERT_TRUE(greek) << greek.error().what;
  EXPECT_EQ(greek->new_devices, "new") << "there is no letter for a file's name, but a device";
}

TEST_F(RigSettings, ASecondCameraThatIsNotCalibratedIsGuessedWithTheFirstAsItIs) {
  auto first = calib::reference_rig();
  first.camera.fx_px = 1100;
  rig_.calibration = scratch_.path() / "first.toml";
  std::ofstream(rig_.calibration) << calib::print_calibration(first);
  rig_.camera2.backend = "v4l2";
  options_.camera2 = {640, 480};
  const auto running = rig_as_it_runs(options_, rig_);
  ASSERT_TRUE(running) << running.error().what;
  const auto file = options_.folder / "rough.toml";
  EXPECT_THAT(running->settings, Contains("calibration=" + file.string()));
  const auto rough = calib::load_calibration(file);
  ASSERT_TRUE(rough) << rough.error().what;
  EXPECT_EQ(rough->camera.fx_px, 1100);
  EXPECT_EQ(rough->camera2->camera.width_px, 640);
}

TEST_F(RigSettings, ACalibrationOfAnotherSecondCameraIsRefused) {
  auto pair = calib::reference_rig();
  pair.camera_device = "usb-1.2";
  pair.camera2 = calib::SecondCamera{"usb-1.3", pair.camera, glm::dmat4(1)};
  pair.camera2->from_camera[3].x = -0.1;
  rig_.calibration = scratch_.path() / "pair.toml";
  std::ofstream(rig_.calibration) << calib::print_calibration(pair);
  rig_.camera.backend = rig_.camera2.backend = "v4l2";
  OwnDevices own{"One", "", {"One", "usb-1.2"}, {}, "Two", {"Two", "usb-1.3"}};
  const auto same = rig_as_it_runs(options_, rig_, own);
  EXPECT_TRUE(same) << same.error().what;
  std::swap(own.camera_names, own.camera2_names);
  EXPECT_FALSE(rig_as_it_runs(options_, rig_, own)) << "the cameras are exchanged";
  std::swap(own.camera_names, own.camera2_names);
  own.camera2_names = {"Three"};
  EXPECT_THAT(rig_as_it_runs(options_, rig_, own).error().what,
              HasSubstr("made with the second camera 'usb-1.3'"));
}

TEST_F(RigSettings, TheTwinShowsWhatAStepNeeds) {
  const auto scene_of = [](Step step, double camera_hz) {
    return entry_of(step).scene(Options{}, camera_hz);
  };
  const auto settings = scene_of(Step::screen, 120);
  EXPECT_THAT(settings, Contains("twin.prop.board=charuco:11x8:20"));
  EXPECT_THAT(settings, Contains("twin.image.leak=1"));
  EXPECT_THAT(settings, Contains("twin.prop.hold_s=8.0"));
  EXPECT_THAT(scene_of(Step::screen, 16), Contains("twin.prop.hold_s=21.0"))
      << "a slow camera needs longer for all patterns";
  EXPECT_THAT(scene_of(Step::pair, 120), Contains("twin.prop.views=both"));
  EXPECT_THAT(scene_of(Step::lens2, 120), Contains("twin.prop.views=second"));
  EXPECT_THAT(scene_of(Step::tracker, 120), Not(Contains(HasSubstr("twin.prop"))));
}

TEST_F(RigSettings, NothingIsComparedWithAGuessedSecondCamera) {
  rig_.camera.backend = rig_.camera2.backend = "twin";
  rig_.pose.backend = "stereo";
  const auto running = rig_as_it_runs(options_, rig_);
  ASSERT_TRUE(running) << running.error().what;
  ASSERT_TRUE(running->is_second_guessed);
  EXPECT_TRUE(check_known(options_, *running)) << "a step measures it";
  options_.rig_file = "rig.toml";
  for (auto* compares : {&options_.check, &options_.correct}) {
    *compares = true;
    const auto known = check_known(options_, *running);
    ASSERT_FALSE(known);
    EXPECT_THAT(known.error().what, HasSubstr("the second camera is not calibrated yet"));
    EXPECT_THAT(known.error().what, HasSubstr("handcast calibrate rig.toml lens2 pair"));
    *compares = false;
  }
}

TEST_F(RigSettings, NothingIsComparedWithACalibrationOfOtherDevices) {
  auto first = calib::reference_rig();
  first.camera_device = "usb-1.2";
  rig_.calibration = scratch_.path() / "first.toml";
  std::ofstream(rig_.calibration) << calib::print_calibration(first);
  rig_.camera.backend = "v4l2";
  const OwnDevices other{"Other Cam", "", {"Other Cam"}, {}};
  const auto refused = [&] { return rig_as_it_runs(options_, rig_, other).error().what; };
  const auto says = [](const std::string& asked) {
    return HasSubstr(
        "first.toml was made with the camera 'usb-1.2', and the rig has 'Other Cam'; " + asked +
        " needs a calibration of the devices that the rig has now");
  };
  options_.check = true;
  EXPECT_THAT(refused(), says("--check")) << "which takes no sizes";
  options_.check = false;
  options_.correct = true;
  EXPECT_THAT(refused(), says("--correct"));
  options_.correct = false;
  options_.points = "points";
  EXPECT_THAT(refused(), says("--points"));
}

TEST_F(RigSettings, ASizeThatWouldHaveNoEffectIsRefused) {
  const RunningAs running{calib::reference_rig(), {}};
  options_.camera = {720, 540};
  EXPECT_TRUE(check_known(options_, running));
  options_.camera = {640, 480};
  EXPECT_THAT(check_known(options_, running).error().what,
              HasSubstr("--camera 640x480 has no effect: the calibration that the rig names has "
                        "720x540"));
}

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
