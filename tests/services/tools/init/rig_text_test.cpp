// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/rig_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "config/rig.hpp"
#include "services/tools/calibrate/options.hpp"
#include "services/tools/doctor/rig_file.hpp"
#include "services/tools/init/report.hpp"
#include "tests/scratch.hpp"
#include "tests/services/tools/init/some_devices.hpp"

namespace handcast::init {
namespace {

using devices::Attached;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class RigText : public testing::Test {
 protected:
  Plan plan_of(const std::vector<Attached>& attached) const {
    const auto plan = interview(attached, options_, nullptr);
    EXPECT_TRUE(plan) << plan.error().what;
    return plan ? *plan : Plan();
  }
  std::string text_of(const std::vector<Attached>& attached) const {
    return rig_text(plan_of(attached), options_.file);
  }
  /// The rig in the text; settings that are not known, or out of range, fail the test.
  static config::Rig read(const std::string& text) {
    const auto rig = config::parse_rig(text, "/srv/my_rig.toml");
    EXPECT_TRUE(rig) << rig.error().what << "\n" << text;
    return rig ? *rig : config::Rig();
  }
  config::Rig rig_of(const std::vector<Attached>& attached) const {
    return read(text_of(attached));
  }
  /// What the doctor says about one part of a rig file. These devices are not attached: see
  /// tests/system/init_test.cpp for what it says about the display.
  static doctor::Grade grade_of(const config::Rig& rig, const std::string& check) {
    for (const auto& finding : doctor::examine_file(rig))
      if (finding.check == check) return finding.grade;
    ADD_FAILURE() << "nothing about " << check;
    return doctor::Grade::fault;
  }
  void calibrate(int width_px, int height_px, int projector_width_px, int projector_height_px) {
    auto calibration = calib::reference_rig();
    calibration.camera.width_px = width_px;
    calibration.camera.height_px = height_px;
    calibration.projector.width_px = projector_width_px;
    calibration.projector.height_px = projector_height_px;
    const std::string file = scratch_.path() / "calibration.toml";
    std::ofstream(file) << calib::print_calibration(calibration);
    options_.flags.calibration = file;
  }

  test::Scratch scratch_;
  Options options_{.file = "/srv/my_rig.toml"};
};

TEST_F(RigText, ARealTrackerIsWrittenWithTheDetectorThatSeesTheSameHand) {
  for (const auto* backend : {"openxr", "leapc"}) {
    const auto text = text_of({colour_webcam(), tracker(backend, "It \n it")});
    EXPECT_THAT(text, AllOf(HasSubstr(std::string("[pose]\n# It ? it\nbackend = \"") + backend),
                            Not(HasSubstr("distance_m"))));
    const auto rig = read(text);
    EXPECT_EQ(rig.pose.backend, backend);
    EXPECT_EQ(rig.landmarks.backend, "handcast") << "the twin's detector sees another hand";
  }
  EXPECT_THAT(report(plan_of({colour_webcam(), tracker("openxr", "Monado")}), "a.toml"),
              HasSubstr("tracker      Monado"));
}

TEST_F(RigText, ForEveryCombinationOfDevicesIsARigThatTheDoctorPasses) {
  const std::vector<std::vector<Attached>> cameras{{},
                                                   {colour_webcam()},
                                                   {infrared_webcam()},
                                                   {industrial_camera()},
                                                   {webcam("A", "/dev/video0", {})}};
  const std::vector<std::vector<Attached>> displays{
      {}, {monitor("HDMI-1", "EPSON PJ", false)}, {connector("HDMI-A-1", "EPSON PJ")}};
  for (const auto& some : cameras)
    for (const auto& display : displays)
      for (const bool is_commanded : {false, true}) {
        auto attached = some;
        attached.insert(attached.end(), display.begin(), display.end());
        if (is_commanded) attached.push_back(controller());
        const auto rig = rig_of(attached);
        EXPECT_EQ(rig.camera.backend == "twin", some.empty());
        EXPECT_EQ(rig.pose.backend, some.empty() ? "twin" : "none");
        EXPECT_EQ(rig.projector.backend == "twin", display.empty());
        EXPECT_EQ(rig.dlp.backend == "lightcrafter", is_commanded && !display.empty());
        EXPECT_EQ(grade_of(rig, "rig file"), doctor::Grade::good);
        EXPECT_EQ(grade_of(rig, "calibration"),
                  some.empty() ? doctor::Grade::good : doctor::Grade::fault)
            << "a real camera without a calibration";
      }
}

TEST_F(RigText, AFileWithASpaceIsOneWordOfTheCommandsThatArePrinted) {
  const auto plan = plan_of({colour_webcam(), connector("HDMI-A-1", "EPSON PJ")});
  for (const auto* verb : {"calibrate", "doctor", "up"})
    EXPECT_THAT(report(plan, "my rig.toml"), HasSubstr(verb + std::string(" 'my rig.toml'")));
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("~a"), "'~a'");
  EXPECT_EQ(shell_word("a-b/ü.toml"), "a-b/ü.toml");
}

TEST_F(RigText, TheCommandThatIsPrintedMeasuresTheseDevicesAndAppliesTheResult) {
  const auto plan = plan_of({colour_webcam(), connector("HDMI-A-1", "EPSON PJ")});
  const auto command = calibrate_command(plan, "my_rig.toml");
  EXPECT_THAT(report(plan, "my_rig.toml"), HasSubstr(command));
  std::istringstream text(command);
  std::vector<std::string> words{std::istream_iterator<std::string>(text), {}};
  ASSERT_GT(words.size(), 2u);
  EXPECT_EQ(words[0] + " " + words[1], "handcast calibrate");
  std::vector<char*> arguments;
  for (std::size_t i = 1; i < words.size(); ++i) arguments.push_back(words[i].data());
  const auto options = calibrate::parse(static_cast<int>(arguments.size()), arguments.data());
  ASSERT_TRUE(options) << options.error().what;
  EXPECT_EQ(options->rig_file, "my_rig.toml");
  EXPECT_TRUE(options->apply) << "else the rig file would not name the calibration";
  EXPECT_EQ(options->camera.width_px, colour_webcam().modes[0].width_px);
  EXPECT_EQ(options->projector.width_px, 1280);
  EXPECT_EQ(options->projector.height_px, 800);
}

TEST_F(RigText, WithACalibrationTheDoctorFindsNoFault) {
  calibrate(640, 480, 1024, 768);
  const auto rig = rig_of({colour_webcam(), connector("HDMI-A-1", "EPSON PJ")});
  EXPECT_EQ(grade_of(rig, "rig file"), doctor::Grade::good);
  EXPECT_EQ(grade_of(rig, "calibration"), doctor::Grade::advice) << "it does not name its camera";
  EXPECT_EQ(rig.calibration, *options_.flags.calibration);
}

TEST_F(RigText, ACalibrationBesideTheFileIsNamedRelativeToIt) {
  calibrate(640, 480, 1024, 768);
  const auto plan = plan_of({colour_webcam()});
  EXPECT_THAT(rig_text(plan, scratch_.path() / "rig.toml"),
              HasSubstr("\ncalibration = \"calibration.toml\"\n"));
  EXPECT_THAT(rig_text(plan, scratch_.path() / "rigs" / "rig.toml"),
              HasSubstr("\ncalibration = \"" + *options_.flags.calibration + "\"\n"));
}

TEST_F(RigText, TheCameraSendsWhatItReallyHas) {
  auto rig = rig_of({colour_webcam()});
  EXPECT_EQ(rig.camera.v4l2.device, "HD Webcam");
  EXPECT_EQ(rig.camera.v4l2.format, config::WebcamFormat::yuyv);
  EXPECT_EQ(rig.camera.rate_hz, 30);
  calibrate(1280, 720, 1024, 768);
  rig = rig_of({colour_webcam()});
  EXPECT_EQ(rig.camera.v4l2.format, config::WebcamFormat::mjpeg) << "YUYV has only 10 Hz";
  EXPECT_EQ(rig.camera.rate_hz, 30);
}

TEST_F(RigText, TheExposureEndsWithinThePeriod) {
  EXPECT_EQ(rig_of({colour_webcam()}).camera.exposure_ms, 4);
  const auto rig = rig_of({industrial_camera()});
  EXPECT_EQ(rig.camera.aravis.device, "23456789");
  EXPECT_EQ(rig.camera.rate_hz, 525);
  EXPECT_LT(rig.camera.exposure_ms, 1000 / rig.camera.rate_hz);
}

TEST_F(RigText, ARateIsNeverAboveTheHighestOne) {
  auto camera = industrial_camera();
  camera.modes[0].rate_hz = 524.9987;
  EXPECT_EQ(rig_of({camera}).camera.rate_hz, 524.99);
  EXPECT_EQ(rig_of({webcam("A", "/dev/video0", {mode(640, 480, 29.97)})}).camera.rate_hz, 29.97);
}

TEST_F(RigText, TheTwinTakesTheModeOfTheReferenceRig) {
  options_.flags.camera = "twin";
  const auto rig = rig_of({connector("HDMI-A-1", "EPSON PJ")});
  EXPECT_EQ(rig.projector.kms.mode, "");
  EXPECT_EQ(rig.projector.rate_hz, 120) << "of 1024x768";
}

TEST_F(RigText, TheDisplayHasAModeOfItsOwn) {
  auto rig = rig_of({infrared_webcam(), connector("HDMI-A-1", "EPSON PJ")});
  EXPECT_EQ(rig.projector.kms.connector, "EPSON PJ");
  EXPECT_EQ(rig.projector.kms.mode, "1280x800@59.81");
  EXPECT_EQ(rig.projector.rate_hz, 59.81);
  calibrate(720, 540, 1024, 768);
  rig = rig_of({connector("HDMI-A-1", "EPSON PJ")});
  EXPECT_EQ(rig.projector.kms.mode, "") << "the size of the calibration";
  EXPECT_EQ(rig.projector.rate_hz, 120);
  calibrate(720, 540, 800, 600);
  const auto text = text_of({connector("HDMI-A-1", "EPSON PJ")});
  EXPECT_EQ(read(text).projector.kms.mode, "1280x800@59.81");
  EXPECT_THAT(text, HasSubstr("the picture is scaled"));
}

TEST_F(RigText, RatesThatADeviceDoesNotSayAreThoseThatAnyHas) {
  auto display = monitor("HDMI-1", "EPSON PJ", false);
  display.modes[0].rate_hz = 0;
  const auto rig = rig_of({webcam("A", "/dev/video0", {mode(640, 480, 0, "YUYV")}), display});
  EXPECT_EQ(rig.projector.rate_hz, 60);
  EXPECT_EQ(rig.camera.rate_hz, 30);
}

TEST_F(RigText, LedsBeginWithLowCurrents) {
  const auto rig = rig_of({connector("HDMI-A-1", "EPSON PJ"), controller()});
  EXPECT_EQ(rig.dlp.device, "LCR3");
  EXPECT_EQ(rig.dlp.mode, config::DlpMode::video);
  EXPECT_LE(rig.dlp.limit, 0.1);
  for (const double current : {rig.dlp.red, rig.dlp.green, rig.dlp.blue}) {
    EXPECT_GT(current, 0);
    EXPECT_LE(current, rig.dlp.limit);
  }
}

TEST_F(RigText, ADevicesNameCannotWriteSettings) {
  auto camera = webcam("A\"\nbackend = \"twin", "/dev/video0", {});
  camera.about = "x\n[dlp]\nbackend = \"lightcrafter\"";
  auto display = connector("HDMI-A-1", "a\\\"b\nlimit = 1");
  const auto rig = rig_of({camera, display});
  EXPECT_EQ(rig.camera.backend, "v4l2");
  EXPECT_EQ(rig.projector.kms.connector, "HDMI-A-1");
  EXPECT_EQ(rig.dlp.backend, "none");
  EXPECT_EQ(rig_of({webcam("A \"B\" \\C", "/dev/video0", {})}).camera.v4l2.device, "A \"B\" \\C");
}

TEST_F(RigText, WhatIsMissingIsSaidInTheFileAndInTheReport) {
  const auto plan = plan_of({colour_webcam(), connector("HDMI-A-1", "EPSON PJ")});
  const auto sizes = HasSubstr("--camera 640x480 --projector 1280x800");
  EXPECT_THAT(rig_text(plan, options_.file), AllOf(HasSubstr("THIS IS MISSING"), sizes));
  EXPECT_THAT(report(plan, options_.file),
              AllOf(HasSubstr("MISSING"), sizes, HasSubstr("handcast up /srv/my_rig.toml")));
  const auto twin = plan_of({});
  EXPECT_THAT(rig_text(twin, options_.file), Not(HasSubstr("MISSING")));
  EXPECT_THAT(report(twin, options_.file), Not(HasSubstr("MISSING")));
}

TEST(Troubles, AreSaidIfNothingElseOfTheirKindCanBeUsed) {
  auto busy = colour_webcam();
  busy.trouble = "another program uses it";
  EXPECT_THAT(troubles_of({busy}), HasSubstr("'HD Webcam'"));
  EXPECT_EQ(troubles_of({busy, infrared_webcam()}), "");
}

}  // namespace
}  // namespace handcast::init
