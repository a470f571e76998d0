// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/session.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "config/settings/files.hpp"
#include "tests/scratch.hpp"

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
  const auto report = text_of(session.report());
  const auto kept = session.keep(Step::lens, {"2 images", false}, with_focal_length(900));
  ASSERT_FALSE(kept);
  EXPECT_THAT(kept.error().what, HasSubstr("measure it again"));
  EXPECT_EQ(session.draft().camera.fx_px, 1200);
  EXPECT_EQ(open().draft().camera.fx_px, 1200);
  EXPECT_EQ(text_of(session.report()), report);
}

TEST_F(CalibrateSession, ANewLensForgetsWhatWasMeasuredWithTheOld) {
  auto session = open();
  ASSERT_TRUE(session.keep(Step::lens, {"one"}, used_));
  ASSERT_TRUE(session.keep(Step::screen, {"two"}, used_));
  EXPECT_TRUE(session.is_done(Step::screen));
  ASSERT_TRUE(session.keep(Step::lens, {"three"}, used_));
  EXPECT_FALSE(session.is_done(Step::screen));
  EXPECT_THAT(text_of(session.report()), Not(HasSubstr("two")));
}

TEST_F(CalibrateSession, TheSecondCamerasPlaceStandsOnBothLensesAndTheScreenOnTheFirst) {
  used_.camera2 = calib::SecondCamera{{}, used_.camera, glm::dmat4(1)};
  used_.camera2->from_camera[3].x = -0.1;
  auto session = open();
  for (const Step step : {Step::lens, Step::lens2, Step::pair, Step::screen})
    ASSERT_TRUE(session.keep(step, {"measured"}, session.draft()));
  EXPECT_THAT(text_of(session.report()), HasSubstr("<h2>pair</h2>"));
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

TEST_F(CalibrateSession, TheReportHasTheFindingsOfEachStep) {
  auto session = open();
  ASSERT_TRUE(session.keep(Step::lens, {"20 images", true, {"tilt <more>"}, "<svg></svg>"}, used_));
  const auto page = text_of(session.report());
  EXPECT_THAT(page, HasSubstr("tilt &lt;more&gt;"));
  EXPECT_THAT(page, HasSubstr("<svg></svg>"));
  EXPECT_THAT(page, HasSubstr("not measured yet"));
}

TEST_F(CalibrateSession, TheOldCalibrationIsKept) {
  const fs::path own = scratch_.path() / "own.toml";
  std::ofstream(own) << calib::print_calibration(used_);
  rig_.calibration = own;
  auto session = open();
  ASSERT_TRUE(session.keep(Step::lens, {"20 images"}, with_focal_length(1200)));
  const auto finished = session.finish();
  ASSERT_TRUE(finished) << finished.error().what;
  EXPECT_EQ(calib::load_calibration(own)->camera.fx_px, 1200);
  const fs::directory_iterator folder(scratch_.path());
  const auto kept = std::find_if(begin(folder), end(folder), [](const auto& entry) {
    return entry.path().filename().string().starts_with("own.2");
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
  unusable.projector_from_camera = glm::dmat3(0);
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
