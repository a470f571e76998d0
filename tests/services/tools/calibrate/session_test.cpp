// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/session.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/settings/files.hpp"
#include "services/tools/calibrate/kept_file.hpp"
#include "tests/scratch.hpp"
#include "tests/small_files.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class CalibrateSession : public testing::Test {
 protected:
  CalibrateSession() {
    options_.rig_file = scratch_.path() / "rig.toml";
    options_.folder = scratch_.path() / "rig.calibration";
  }
  Session open() { return *Session::open(options_, rig_, used_); }
  /// The calibration in use with another lens.
  calib::Calibration with_focal_length(double fx_px) const {
    auto measured = used_;
    measured.camera.fx_px = fx_px;
    return measured;
  }
  std::string text_of(const fs::path& file) const { return *config::read_text(file); }
  std::string report_of(const Session& session) const {
    return text_of(session.file("report.json"));
  }

  test::Scratch scratch_;
  Options options_;
  config::Rig rig_;
  calib::Calibration used_ = calib::reference_rig();
};

TEST_F(CalibrateSession, GoesOnWhereItWasLeft) {
  { ASSERT_TRUE(open().keep(Step::lens, {"20 images"}, with_focal_length(1200))); }
  auto session = open();
  EXPECT_TRUE(session.is_done(Step::lens));
  EXPECT_FALSE(session.is_done(Step::screen));
  EXPECT_EQ(session.draft().camera.fx_px, 1200);
  options_.restart = true;
  EXPECT_FALSE(open().is_done(Step::lens));
}

TEST_F(CalibrateSession, AMeasurementThatIsNotGoodChangesNothing) {
  ASSERT_TRUE(open().keep(Step::lens, {"20 images"}, with_focal_length(1200)));
  auto session = open();
  const auto report = report_of(session), lens = text_of(session.file("lens.json"));
  const auto kept = session.keep(Step::lens, {"2 images", false}, with_focal_length(900));
  ASSERT_FALSE(kept);
  EXPECT_THAT(kept.error().what, HasSubstr("measure it again"));
  EXPECT_EQ(session.draft().camera.fx_px, 1200);
  EXPECT_EQ(open().draft().camera.fx_px, 1200);
  EXPECT_EQ(report_of(session), report);
  EXPECT_EQ(text_of(session.file("lens.json")), lens);
}

TEST_F(CalibrateSession, AMeasurementIsKeptAlthoughItsFindingsCannotBeWritten) {
  fs::create_directories(options_.folder / "lens.json" / "a folder in its place");
  const auto kept = open().keep(Step::lens, {"20 images"}, with_focal_length(1200));
  ASSERT_FALSE(kept);
  EXPECT_THAT(kept.error().what, HasSubstr("lens.json"));
  EXPECT_EQ(open().draft().camera.fx_px, 1200);
}

TEST_F(CalibrateSession, OldFiguresDoNotStandUnderANewMeasurement) {
  ASSERT_TRUE(open().keep(Step::lens, {"20 images"}, with_focal_length(1200)));
  Outcome large{"30 images"};
  large.pictures = {{"dots", "", {{"x", std::vector<double>(100'000, 0.5)}}}};
  {
    const test::SmallFiles full(100'000);
    EXPECT_FALSE(open().keep(Step::lens, large, with_focal_length(1300)));
  }
  EXPECT_EQ(open().draft().camera.fx_px, 1300);
  auto session = open();
  EXPECT_FALSE(fs::exists(session.file("lens.json")));
  ASSERT_TRUE(session.keep(Step::light, {"bright"}, session.draft()));
  EXPECT_THAT(report_of(session), HasSubstr("30 images"));
  EXPECT_THAT(report_of(session), Not(HasSubstr("20 images")));
}

TEST_F(CalibrateSession, TheReportGoesOnWithItsBoardAndItsFolder) {
  const auto report = [&] {
    auto session = open();
    EXPECT_TRUE(session.keep(Step::lens, {"20 images"}, used_));
    return nlohmann::json::parse(report_of(session));
  };
  const auto usual = report();
  EXPECT_EQ(usual["rig_file"], options_.rig_file.string());
  EXPECT_EQ(usual["board"], "");
  EXPECT_EQ(usual["folder"], "");
  options_.board.square_mm = 25;
  options_.folder = scratch_.path() / "other";
  const auto other = report();
  EXPECT_EQ(other["board"], "charuco:11x8:25");
  EXPECT_EQ(other["folder"], options_.folder.string());
}

TEST_F(CalibrateSession, ADamagedDraftIsRefusedWithTheWayOut) {
  fs::create_directories(options_.folder);
  std::ofstream(options_.folder / "draft.toml") << "not a calibration";
  const auto session = Session::open(options_, rig_, used_);
  ASSERT_FALSE(session);
  EXPECT_THAT(session.error().what, HasSubstr("draft.toml"));
  EXPECT_THAT(session.error().what, HasSubstr("--restart"));
  options_.restart = true;
  EXPECT_TRUE(Session::open(options_, rig_, used_));
}

TEST_F(CalibrateSession, ANewLensForgetsWhatWasMeasuredWithTheOld) {
  auto session = open();
  ASSERT_TRUE(session.keep(Step::lens, {"one"}, used_));
  ASSERT_TRUE(session.keep(Step::screen, {"two"}, used_));
  EXPECT_TRUE(session.is_done(Step::screen));
  ASSERT_TRUE(session.keep(Step::lens, {"three"}, used_));
  EXPECT_FALSE(session.is_done(Step::screen));
  EXPECT_THAT(report_of(session), Not(HasSubstr("two")));
  EXPECT_FALSE(fs::exists(session.file("screen.json")));
}

TEST_F(CalibrateSession, TheSecondCamerasPlaceStandsOnBothLensesAndTheScreenOnTheFirst) {
  used_.camera2 = calib::SecondCamera{{}, used_.camera, glm::dmat4(1)};
  used_.camera2->from_camera[3].x = -0.1;
  auto session = open();
  for (const Step step : {Step::lens, Step::lens2, Step::pair, Step::screen})
    ASSERT_TRUE(session.keep(step, {"measured"}, session.draft()));
  EXPECT_TRUE(fs::exists(session.file("pair.json")));
  ASSERT_TRUE(session.keep(Step::lens2, {"again"}, session.draft()));
  EXPECT_FALSE(session.is_done(Step::pair));
  EXPECT_TRUE(session.is_done(Step::screen));
  ASSERT_TRUE(session.keep(Step::pair, {"again"}, session.draft()));
  ASSERT_TRUE(session.keep(Step::lens, {"again"}, session.draft()));
  EXPECT_FALSE(session.is_done(Step::pair));
  EXPECT_TRUE(session.is_done(Step::lens2));
}

TEST_F(CalibrateSession, APlaceOfTheSecondCameraThatNobodyMeasuredIsNotWritten) {
  rig_.calibration = scratch_.path() / "own.toml";
  std::ofstream(rig_.calibration) << calib::print_calibration(used_);
  used_.camera2 = calib::SecondCamera{{}, used_.camera, glm::dmat4(1)};
  used_.camera2->from_camera[3].x = -0.1;
  auto session = open();
  ASSERT_TRUE(session.keep(Step::lens2, {"20 images"}, used_));
  ASSERT_TRUE(session.finish());
  EXPECT_FALSE(calib::load_calibration(session.target())->camera2);
  ASSERT_TRUE(session.keep(Step::pair, {"15 views"}, session.draft()));
  ASSERT_TRUE(session.finish());
  const auto whole = calib::load_calibration(session.target());
  ASSERT_TRUE(whole->camera2);
  EXPECT_THAT(whole->made.pair, HasSubstr("15 views"));
  EXPECT_THAT(text_of(session.file("opencv.yml")), HasSubstr("camera2_from_camera"));
}

TEST_F(CalibrateSession, ADraftOfAnotherSecondCameraIsRefused) {
  used_.camera2 = calib::SecondCamera{"left eye", used_.camera, glm::dmat4(1)};
  used_.camera2->from_camera[3].x = -0.1;
  { ASSERT_TRUE(open().keep(Step::lens, {"20 images"}, used_)); }
  used_.camera2->device = "right eye";
  const auto other = Session::open(options_, rig_, used_);
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().what, HasSubstr("it was the second camera 'left eye'"));
  used_.camera2->device = "left eye";
  used_.camera2->camera.width_px = 640;
  EXPECT_THAT(Session::open(options_, rig_, used_).error().what, HasSubstr("second camera"));
}

TEST_F(CalibrateSession, TheFindingsOfEachStepAreKeptForTheReport) {
  auto session = open();
  ASSERT_TRUE(session.keep(Step::lens, {"20 images", true, {"tilt more"}}, used_));
  EXPECT_THAT(text_of(session.file("lens.json")), HasSubstr("tilt more"));
  const auto steps = nlohmann::json::parse(report_of(session))["steps"];
  EXPECT_EQ(steps[0]["step"], "lens");
  EXPECT_EQ(steps[0]["is_done"], true);
  EXPECT_EQ(steps[1]["is_done"], false);
}

TEST_F(CalibrateSession, TheOldCalibrationIsKept) {
  const fs::path own = scratch_.path() / "own.toml";
  std::ofstream(own) << calib::print_calibration(used_);
  rig_.calibration = own;
  auto session = open();
  ASSERT_TRUE(session.keep(Step::lens, {"20 images"}, with_focal_length(1200)));
  const auto finished = session.finish(4);
  ASSERT_TRUE(finished) << finished.error().what;
  EXPECT_EQ(calib::load_calibration(own)->camera.fx_px, 1200);
  const fs::directory_iterator folder(scratch_.path());
  const auto kept = std::find_if(begin(folder), end(folder), [](const auto& entry) {
    return entry.path().filename().string().starts_with("own.0005-");
  });
  ASSERT_NE(kept, end(folder));
  EXPECT_EQ(calib::load_calibration(kept->path())->camera.fx_px, used_.camera.fx_px);
  EXPECT_THAT(*finished, HasSubstr(kept->path().filename().string()));
}

TEST_F(CalibrateSession, ADraftThatServicesWouldRefuseDoesNotTakeThePlaceOfAGoodOne) {
  const fs::path own = scratch_.path() / "own.toml";
  std::ofstream(own) << calib::print_calibration(used_);
  rig_.calibration = own;
  auto session = open();
  auto unusable = used_;
  unusable.projector.from_camera = glm::dmat3(0);
  ASSERT_TRUE(session.keep(Step::screen, {"nonsense"}, unusable));
  const auto finished = session.finish();
  ASSERT_FALSE(finished);
  EXPECT_THAT(finished.error().what, HasSubstr("homography"));
  EXPECT_TRUE(calib::load_calibration(own));
}

TEST_F(CalibrateSession, ADraftOfAnotherCameraIsRefused) {
  ASSERT_TRUE(open().keep(Step::lens, {"20 images"}, used_));
  used_.camera.width_px = 640;
  const auto session = Session::open(options_, rig_, used_);
  ASSERT_FALSE(session);
  EXPECT_THAT(session.error().what, HasSubstr("--restart"));
}

TEST_F(CalibrateSession, WhatIsNotInItsPlaceYetIsPending) {
  EXPECT_FALSE(open().is_pending());
  { ASSERT_TRUE(open().keep(Step::lens, {"20 images"}, used_)); }
  EXPECT_TRUE(open().is_pending());
  ASSERT_TRUE(open().finish());
  EXPECT_FALSE(open().is_pending());
  { ASSERT_TRUE(open().keep(Step::light, {"bright"}, open().draft())); }
  EXPECT_FALSE(open().is_pending()) << "the light is no part of a calibration";
  { ASSERT_TRUE(open().keep(Step::screen, {"5 places"}, open().draft())); }
  EXPECT_TRUE(open().is_pending());
  options_.restart = true;
  EXPECT_FALSE(open().is_pending());
  options_.restart = false;
  EXPECT_FALSE(open().is_pending());
  EXPECT_FALSE(open().is_done(Step::lens)) << "--restart has forgotten it";
}

TEST_F(CalibrateSession, ACalibrationThatIsNoLongerThereIsPending) {
  auto session = open();
  ASSERT_TRUE(session.keep(Step::lens, {"20 images"}, used_));
  ASSERT_TRUE(session.finish());
  fs::remove(session.target());
  EXPECT_TRUE(open().is_pending());
}

TEST_F(CalibrateSession, SettingsAreKeptUntilTheyAreMeasuredAnewOrForgotten) {
  const auto paths_of = [](const std::vector<config::MeasuredSetting>& settings) {
    std::string text;
    for (const auto& setting : settings) text += setting.path + "=" + setting.value + " ";
    return text;
  };
  const auto with = [](std::vector<config::MeasuredSetting> settings) {
    return Outcome{"measured", true, {}, {}, std::move(settings)};
  };
  ASSERT_TRUE(open().keep(Step::light, with({{"projector.latency_ms", "3"}}), used_));
  ASSERT_TRUE(open().keep(
      Step::screen, with({{"projector.latency_ms", "8"}, {"projector.gamma", "1.80"}}), used_));
  EXPECT_EQ(paths_of(open().settings()), "projector.latency_ms=8 projector.gamma=1.8 ");
  ASSERT_TRUE(open().keep(Step::screen, with({{"projector.gamma", "1.90"}}), used_));
  EXPECT_EQ(paths_of(open().settings()), "projector.gamma=1.9 ");
  ASSERT_TRUE(open().keep(Step::lens, with({}), used_));
  EXPECT_EQ(paths_of(open().settings()), "") << "the screen was forgotten with the old lens";
  ASSERT_TRUE(open().keep(Step::light, with({{"projector.latency_ms", "3"}}), used_));
  open().forget_settings();
  EXPECT_EQ(paths_of(open().settings()), "");
}

TEST_F(CalibrateSession, AFileThatHoldsNoSettingsIsIgnoredWithASentence) {
  const auto session = open();
  const auto file = session.file("screen.settings");
  const std::string good = "projector.gamma = 1.8\n";
  for (const auto& bad :
       {std::string(), std::string("gamma"), std::string("a b = 1\n"), good + "projector.x = \"\n",
        good + "projector.x = nan\n", good + "projector.x = 1\n"}) {
    std::ofstream(file) << bad;
    testing::internal::CaptureStderr();
    EXPECT_TRUE(session.settings().empty()) << bad;
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("screen.settings"));
  }
  std::ofstream(file) << good;
  EXPECT_EQ(session.settings().size(), 1U);
  fs::remove(file);
  fs::create_directory(file);
  testing::internal::CaptureStderr();
  EXPECT_TRUE(session.settings().empty());
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("screen.settings"));
}

TEST_F(CalibrateSession, AFolderThatCannotBeReadIsNamed) {
  const fs::path loop = scratch_.path() / "loop";
  fs::create_symlink(loop, loop);
  fs::create_directories(options_.folder);
  fs::create_symlink(loop, options_.folder / "draft.toml");
  const auto session = Session::open(options_, rig_, used_);
  ASSERT_FALSE(session);
  EXPECT_THAT(session.error().what, HasSubstr("rig.calibration"));
}

TEST_F(CalibrateSession, TheReportNamesNoStepThatTheRigHasNoNeedOf) {
  const auto page_of = [&] {
    EXPECT_TRUE(open().keep(Step::lens, {"20 images"}, used_));
    return report_of(open());
  };
  EXPECT_THAT(page_of(), HasSubstr("tracker"));
  EXPECT_THAT(page_of(), Not(HasSubstr("pair")));
  rig_.pose.backend = "stereo";
  EXPECT_THAT(page_of(), Not(HasSubstr("tracker")));
  EXPECT_THAT(page_of(), HasSubstr("pair"));
}

TEST_F(CalibrateSession, TheDevicesAreNamedAndADraftOfOthersIsRefused) {
  used_.camera_device = "HD Webcam";
  auto session = open();
  ASSERT_TRUE(session.keep(Step::lens, {"20 images"}, session.draft()));
  ASSERT_TRUE(session.finish());
  EXPECT_EQ(calib::load_calibration(session.target())->camera_device, "HD Webcam");
  EXPECT_THAT(text_of(session.file("opencv.yml")), HasSubstr("\"HD Webcam\""));

  used_.projector_device = "EPSON PJ";  // was not known before
  EXPECT_EQ(open().draft().projector_device, "EPSON PJ");
  used_.camera_device = "Other Webcam";
  const auto other = Session::open(options_, rig_, used_);
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().what, HasSubstr("'HD Webcam', and now it is 'Other Webcam'"));
  EXPECT_THAT(other.error().what, HasSubstr("--restart"));
}

}  // namespace
}  // namespace handcast::calibrate
