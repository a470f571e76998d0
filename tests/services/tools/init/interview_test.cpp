// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/interview.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "config/rig.hpp"
#include "services/tools/devices/trackers.hpp"
#include "services/tools/init/rig_text.hpp"
#include "tests/scratch.hpp"
#include "tests/services/tools/init/some_devices.hpp"

namespace handcast::init {
namespace {

using devices::Attached;
using testing::AllOf;
using testing::HasSubstr;

class Interview : public testing::Test {
 protected:
  /// Asks a person who answers with these lines.
  Result<Plan> ask(const std::vector<Attached>& attached, const std::string& lines) {
    std::istringstream in(lines);
    shown_ = std::ostringstream();
    Prompt prompt(in, shown_);
    return interview(attached, options_, &prompt);
  }
  Result<Plan> guess(const std::vector<Attached>& attached) {
    return interview(attached, options_, nullptr);
  }
  long questions() const { return std::ranges::count(shown_.str(), '?'); }
  std::string write(const calib::Calibration& calibration) const {
    const std::string file = scratch_.path() / "calibration.toml";
    std::ofstream(file) << calib::print_calibration(calibration);
    return file;
  }
  static std::string refusal_of(const Result<Plan>& plan) {
    return plan ? "none" : plan.error().what;
  }

  Options options_{.file = "my rig.toml"};
  std::ostringstream shown_;
  test::Scratch scratch_;
};

TEST_F(Interview, WithRealDevicesFiveQuestionsAreAsked) {
  const std::vector<Attached> attached{colour_webcam(), monitor("HDMI-1", "EPSON PJ", false),
                                       controller()};
  const auto plan = ask(attached, "\n\n0.9\nnone\nstage\n");
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(questions(), 5);
  EXPECT_EQ(plan->camera.word, "v4l2:HD Webcam");
  EXPECT_EQ(plan->light.word, "window:EPSON PJ");
  EXPECT_EQ(plan->tracker, Tracker::none) << "the only one that sees a real hand";
  EXPECT_EQ(plan->distance_m, 0.9);
  EXPECT_EQ(plan->name, "stage");
  ASSERT_TRUE(plan->controller);
  EXPECT_EQ(plan->controller->name, "LCR3");
  EXPECT_TRUE(plan->needs_calibration());
}

TEST_F(Interview, WithoutDevicesTheTwinNeedsNoAnswerToWhatItKnows) {
  const auto plan = ask({}, "\n\n\n");
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(questions(), 3) << "light, tracker and name";
  EXPECT_EQ(plan->camera.word, "twin");
  EXPECT_EQ(plan->light.word, "twin");
  EXPECT_EQ(plan->tracker, Tracker::twin);
  EXPECT_EQ(plan->name, "my_rig") << "that of the file, as far as a rig can have it";
  EXPECT_FALSE(plan->controller);
  EXPECT_FALSE(plan->needs_calibration());
}

TEST_F(Interview, NobodyToAskGivesTheBestGuesses) {
  const auto plan = guess({infrared_webcam(), connector("HDMI-A-1", "EPSON PJ")});
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(plan->camera.word, "v4l2:IR Webcam");
  EXPECT_EQ(plan->light.word, "kms:EPSON PJ");
  EXPECT_EQ(plan->distance_m, 0.73);
}

TEST_F(Interview, FlagsAnswerAllQuestions) {
  options_.flags = {.camera = "HD Webcam",
                    .output = "file",
                    .tracker = "none",
                    .distance = "0.5",
                    .calibration = "none",
                    .name = "one"};
  const auto plan = ask({colour_webcam(), infrared_webcam(), controller()}, "");
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(questions(), 0);
  EXPECT_EQ(plan->camera.word, "v4l2:HD Webcam");
  EXPECT_EQ(plan->light.word, "file");
  EXPECT_EQ(plan->distance_m, 0.5);
  EXPECT_FALSE(plan->controller) << "no light goes to a projector";
}

TEST_F(Interview, ATrackerThatCanBeUsedIsOfferedFirstAndNeedsNoDistance) {
  const std::vector<Attached> attached{
      colour_webcam(), monitor("HDMI-1", "EPSON PJ", false),
      tracker("leapc", "Leap Motion Controller", "Ultraleap's library is missing"),
      tracker("openxr", "OpenXR runtime Monado")};
  const auto plan = ask(attached, "\n\n\nnone\nstage\n");
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(plan->tracker, Tracker::openxr);
  EXPECT_EQ(plan->tracker_name, "OpenXR runtime Monado");
  EXPECT_EQ(questions(), 5) << "camera, light, tracker, calibration, name";
  EXPECT_THAT(shown_.str(), HasSubstr("cannot be used now: Ultraleap's library is missing"));
  options_.flags = {.tracker = "leapc"};
  EXPECT_EQ(guess(attached).value().tracker, Tracker::leapc) << "it may be usable later";
  options_.flags = {.distance = "1"};
  EXPECT_THAT(refusal_of(guess(attached)), HasSubstr("--distance: it counts only without"));
}

TEST_F(Interview, ARealTrackerDoesNotSeeTheTwinsHand) {
  options_.flags = {.camera = "twin", .tracker = "openxr"};
  EXPECT_THAT(refusal_of(guess({tracker("openxr", "OpenXR runtime Monado")})),
              HasSubstr("--tracker: a real tracker does not see the twin's hand"));
  EXPECT_THAT(refusal_of(guess({})), HasSubstr("'openxr' is not none or twin"));
}

TEST_F(Interview, ARigIsWrittenBeforeItsDevicesAreThere) {
  options_.flags = {.camera = "aravis:23456789",
                    .output = "window:EPSON PJ",
                    .tracker = "openxr",
                    .calibration = "none"};
  const auto plan = guess({});
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(plan->camera.backend, "aravis");
  EXPECT_EQ(plan->camera.name, "23456789");
  EXPECT_EQ(plan->light.backend, "window");
  EXPECT_EQ(plan->light.name, "EPSON PJ");
  EXPECT_EQ(plan->tracker, Tracker::openxr);
  const auto text = rig_text(*plan, "/nowhere/rig.toml");
  const auto rig = config::parse_rig(text, "/nowhere/rig.toml");
  ASSERT_TRUE(rig) << rig.error().what << text;
  EXPECT_EQ(rig->camera.backend, "aravis");
  EXPECT_EQ(rig->camera.aravis.device, "23456789");
  EXPECT_EQ(rig->projector.window.monitor, "EPSON PJ");
  EXPECT_THAT(text, HasSubstr("23456789, which is not attached now"));
  options_.flags = {.camera = "nobody:1"};
  EXPECT_THAT(refusal_of(guess({})), HasSubstr("aravis:NAME or v4l2:NAME is one that is not"));
}

TEST_F(Interview, ATrackerThatIsNotThereIsNamedWithItsRemedy) {
  const auto absent = devices::absent_trackers();
  if (std::ranges::find(absent, "leapc", &devices::AbsentTracker::backend) == absent.end())
    GTEST_SKIP() << "Ultraleap's software is installed";
  options_.flags = {.tracker = "leapc"};
  const auto plan = guess({colour_webcam()});
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(plan->tracker, Tracker::leapc);
  EXPECT_THAT(plan->tracker_name,
              HasSubstr("leapc, which is not there now: no device of Ultraleap is attached, and "
                        "Ultraleap's library is missing; install"));
}

TEST_F(Interview, ASettingThatCannotWorkIsRefusedWithItsFlag) {
  const auto refused = [this](Flags flags) {
    options_.flags = std::move(flags);
    return refusal_of(guess({colour_webcam()}));
  };
  EXPECT_THAT(refused({.camera = "kinect"}), HasSubstr("--camera: there is no 'kinect'"));
  EXPECT_THAT(refused({.output = "beamer"}), HasSubstr("--output: "));
  EXPECT_THAT(refused({.tracker = "twin"}),
              HasSubstr("--tracker: the twin's tracker does not see"));
  EXPECT_THAT(refused({.tracker = "leap"}), HasSubstr("--tracker: 'leap' is not none or twin"));
  EXPECT_THAT(refused({.tracker = "stereo"}), HasSubstr("copy config/rigs/stereo.toml"));
  for (const auto* distance : {"far", "0", "11", "nan", "0,7", "70 cm", "-1"})
    EXPECT_THAT(refused({.distance = distance}), HasSubstr("--distance: ")) << distance;
  EXPECT_EQ(refused({.distance = "0.7 m"}), "none");
  EXPECT_THAT(refused({.camera = "twin", .distance = "1"}), HasSubstr("--distance: "));
  EXPECT_EQ(refused({.camera = "twin", .tracker = "none", .distance = "1"}), "none");
  EXPECT_THAT(refused({.calibration = "/nowhere.toml"}), HasSubstr("--calibration: /nowhere.toml"));
  EXPECT_THAT(refused({.name = "a b"}), HasSubstr("--name: 'a b'"));
}

TEST_F(Interview, ACalibrationMustBeThatOfTheDevices) {
  auto calibration = calib::reference_rig();
  calibration.camera.width_px = 1280;
  calibration.camera.height_px = 720;
  calibration.camera_device = "HD Webcam";
  calibration.projector_device = "HDMI-1";
  options_.flags.calibration = write(calibration);
  const auto screen = monitor("HDMI-1", "EPSON PJ", false);
  const auto plan = guess({colour_webcam(), screen});
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_FALSE(plan->needs_calibration());
  EXPECT_EQ(images_of(*plan)->rate_hz, 30);
  EXPECT_THAT(refusal_of(guess({infrared_webcam(), screen})),
              AllOf(HasSubstr("made with the camera 'HD Webcam'"), HasSubstr("'IR Webcam'")));
  EXPECT_THAT(refusal_of(guess({colour_webcam(), monitor("HDMI-2", "BenQ", false)})),
              HasSubstr("made with the projector 'HDMI-1'"));
  calibration.camera.width_px = 720;
  write(calibration);
  EXPECT_THAT(refusal_of(guess({colour_webcam(), screen})),
              HasSubstr("images of 720x720, which this camera does not send"));
}

TEST_F(Interview, ACalibrationThatDoesNotFitIsAskedForAgain) {
  auto calibration = calib::reference_rig();
  calibration.camera.width_px = 640;
  calibration.camera.height_px = 480;
  const auto file = write(calibration);
  const auto plan = ask({colour_webcam()}, "\n\n\n/nowhere.toml\n" + file + "\n\n");
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(plan->calibration_file, file);
  const auto none = ask({colour_webcam()}, "\n\n\n/nowhere.toml\nnone\n\n");
  ASSERT_TRUE(none) << none.error().what;
  EXPECT_TRUE(none->needs_calibration());
}

TEST_F(Interview, AControllerThatCanBeOpenedIsTakenBeforeOthers) {
  auto closed = controller();
  closed.trouble = "this user may not open it";
  auto open = controller();
  open.names = {"LCR4", "/dev/hidraw1"};
  const auto plan = guess({connector("HDMI-A-1", "EPSON PJ"), closed, open});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->controller->name, "LCR4");
  EXPECT_EQ(guess({connector("HDMI-A-1", "EPSON PJ"), closed})->controller->name, "LCR3");
}

}  // namespace
}  // namespace handcast::init
