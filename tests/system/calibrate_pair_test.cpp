// SPDX-License-Identifier: Apache-2.0
// `handcast calibrate` measures the second camera of the twin, whose truth is known.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
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
  EXPECT_THAT(page, HasSubstr("<h2>pair</h2>"));
  EXPECT_THAT(page, HasSubstr("Where the second camera saw the board"));

  const auto undone = calibrate_pair({"--undo"});
  ASSERT_EQ(undone.exit_code, 0) << undone.log;
  EXPECT_FALSE(calib::load_calibration(scratch_.path() / "own.toml")->camera2);
}

TEST_F(CalibratePair, ARigWithOneCameraHasNoPlaceOfASecond) {
  const auto outcome = handcast(
      {"calibrate", "config/rigs/twin.toml", "pair", "--folder", scratch_.path() / "session"});
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.log, HasSubstr("the rig has no second camera"));
}

}  // namespace
}  // namespace handcast::system_test
