// SPDX-License-Identifier: Apache-2.0
// `handcast calibrate` measures the second camera of the twin, whose truth is known.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>

#include "calib/calibration.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Two cameras, of which only the first one is calibrated. The lens of the second one is not that
/// of the first one.
class CalibratePair : public SystemTest {
 protected:
  CalibratePair() : truth_(calib::load_calibration("config/calibrations/stereo.toml").value()) {
    auto own = truth_;
    own.camera2.reset();
    truth_.camera2->camera.fx_px = truth_.camera2->camera.fy_px = 1150;
    write("truth.toml", calib::print_calibration(truth_));
    write("own.toml", calib::print_calibration(own));
    write("stereo.toml",
          "name = \"stereo\"\ncalibration = \"own.toml\"\n[camera]\nrate_hz = 15\n"
          "[camera2]\nbackend = \"twin\"\nrate_hz = 15\n[pose]\nbackend = \"stereo\"\n"
          "[landmarks]\nbackend = \"twin\"\n[landmarks2]\nbackend = \"twin\"\n[observer]\n"
          "enabled = false\n[twin.geometry]\ncalibration = \"truth.toml\"\n");
  }
  void write(const char* name, const std::string& text) const {
    std::ofstream(scratch_.path() / name) << text;
  }
  Outcome calibrate_pair(Arguments more) const {
    more.insert(more.begin(), {"calibrate", scratch_.path() / "stereo.toml"});
    return handcast(more);
  }

  calib::Calibration truth_;
};

TEST_F(CalibratePair, TheTwinsSecondCameraIsFoundAndWrittenAndTakenBack) {
  const auto measured = calibrate_pair({"--yes", "lens2", "pair", "--most-s", "140"});
  ASSERT_EQ(measured.exit_code, 0) << measured.log;
  const auto found = calib::load_calibration(scratch_.path() / "own.toml");
  ASSERT_TRUE(found) << found.error().what;
  ASSERT_TRUE(found->camera2);
  EXPECT_NEAR(found->camera2->camera.fx_px / 1150, 1, 0.01);
  EXPECT_THAT(found->made.pair, HasSubstr("mm apart"));
  const auto& from_camera = found->camera2->from_camera;
  EXPECT_NEAR(glm::length(glm::dvec3(from_camera[3])), 0.3, 0.002);
  const glm::dvec4 middle(0, 0, 0.73, 1);
  EXPECT_LT(glm::distance(from_camera * middle, truth_.camera2->from_camera * middle), 0.008)
      << "the error of a principal point turns a camera";
  std::ifstream report(scratch_.path() / "stereo.calibration" / "report.html");
  const std::string page((std::istreambuf_iterator<char>(report)), {});
  EXPECT_THAT(page, HasSubstr("<h2>Place of the second camera"));
  EXPECT_THAT(page, HasSubstr("Where the second camera saw the board"));

  const auto undone = calibrate_pair({"--undo"});
  ASSERT_EQ(undone.exit_code, 0) << undone.log;
  EXPECT_FALSE(calib::load_calibration(scratch_.path() / "own.toml")->camera2);
}

/// An installed rig, whose second camera may have moved: it is where truth.toml says.
class CheckOfAPair : public CalibratePair {
 protected:
  CheckOfAPair() { write("own.toml", calib::print_calibration(truth_)); }
  /// `moved`: from where the second camera was to where it is, in its own axes.
  void move_second(const glm::dmat4& moved) const {
    auto now = truth_;
    now.camera2->from_camera = moved * now.camera2->from_camera;
    write("truth.toml", calib::print_calibration(now));
  }
  Outcome check(const char* most_s = "40") const {
    return calibrate_pair({"--check", "--yes", "--most-s", most_s});
  }
};

TEST_F(CheckOfAPair, ASecondCameraThatWasBumpedIsFoundAndAnotherIsNotAccused) {
  const auto good = check();
  EXPECT_EQ(good.exit_code, 0) << good.log;
  EXPECT_THAT(good.output, HasSubstr("pair: as calibrated"));
  EXPECT_THAT(good.output, HasSubstr("screen: as calibrated"));
  move_second(glm::rotate(glm::dmat4(1), 0.01, {1, 0, 0}));  // 0.6 degrees
  const auto bumped = check();
  EXPECT_EQ(bumped.exit_code, 1) << bumped.log;
  EXPECT_THAT(bumped.output, HasSubstr("pair: has moved"));
  EXPECT_THAT(bumped.output, HasSubstr("screen: as calibrated"));
  EXPECT_THAT(bumped.log, HasSubstr("measure the step `pair` again"));
}

TEST_F(CheckOfAPair, OneThatLooksAwayIsFoundByWhatItShouldSee) {
  // 0.6 rad: it sees a part of what the first one sees, but not the board.
  move_second(glm::rotate(glm::dmat4(1), 0.6, {0, 1, 0}));
  const auto away = check("15");
  EXPECT_EQ(away.exit_code, 1) << away.log;
  EXPECT_THAT(away.output, HasSubstr("pair: has moved"));
  EXPECT_THAT(away.log, HasSubstr("looks elsewhere, or is covered"));
}

TEST_F(CheckOfAPair, WorksBesideARigThatIsUpAndLeavesItUp) {
  std::ofstream(scratch_.path() / "stereo.toml", std::ios::app)
      << "[twin.prop]\nkind = \"board\"\nviews = \"both\"\nhold_s = 60\n"
         "[twin.image]\nleak = 1\ngain = 80\n";
  Command rig(scratch_.path(),
              {"up", scratch_.path() / "stereo.toml", "--set", "projector.rate_hz=57"});
  ASSERT_TRUE(eventually([&] { return !status().is_null() && light() > 0; })) << rig.log();
  const auto refused = calibrate_pair({"pair", "--yes"});
  EXPECT_EQ(refused.exit_code, 100);
  EXPECT_THAT(refused.log, HasSubstr("stop it with `handcast down`"));
  EXPECT_THAT(calibrate_pair({"--check", "--set", "twin.prop.hold_s=1"}).log,
              HasSubstr("--set cannot change it"));
  const auto checked = check();
  EXPECT_EQ(checked.exit_code, 0) << checked.log;
  EXPECT_THAT(checked.output, HasSubstr("pair: as calibrated"));
  EXPECT_THAT(checked.output, HasSubstr("screen: as calibrated"));
  expect_more_light();
  auto other = truth_;
  other.camera2->from_camera[3].x += 0.001;
  write("own.toml", calib::print_calibration(other));
  EXPECT_THAT(check().log, HasSubstr("`handcast reload` first"));
}

TEST_F(CalibratePair, ARigWithOneCameraHasNoPlaceOfASecond) {
  const auto outcome = handcast(
      {"calibrate", "config/rigs/twin.toml", "pair", "--folder", scratch_.path() / "session"});
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.log, HasSubstr("the rig has no second camera"));
}

}  // namespace
}  // namespace handcast::system_test
