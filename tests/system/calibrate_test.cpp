// SPDX-License-Identifier: Apache-2.0
// `handcast calibrate` measures the twin, whose truth is known.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "calib/calibration.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Calibrate : public SystemTest {
 protected:
  /// Copies the rig file of the twin, so that what is measured stays in the folder of the test.
  std::string rig_file() const {
    const fs::path file = scratch_.path() / "twin.toml";
    fs::copy_file("config/rigs/twin.toml", file, fs::copy_options::skip_existing);
    return file;
  }
  Outcome calibrate(Arguments more) const {
    Arguments arguments{"calibrate", rig_file(),         "--yes", "--set", "observer.enabled=false",
                        "--set",     "camera.rate_hz=30"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return handcast(arguments);
  }
};

TEST_F(Calibrate, TheTwinsLensIsFoundAndWrittenAsACalibration) {
  const auto outcome = calibrate({"lens", "--most-s", "30"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_THAT(outcome.output, HasSubstr("report.html"));
  EXPECT_TRUE(fs::exists(scratch_.path() / "twin.calibration" / "report.html"));
  const auto found = calib::load_calibration(scratch_.path() / "twin_calibration.toml");
  ASSERT_TRUE(found) << found.error().what;
  const auto truth = calib::reference_rig().camera;
  EXPECT_NEAR(found->camera.fx_px / truth.fx_px, 1, 0.01);
  const glm::dvec2 corner(40, 40);
  EXPECT_LT(glm::distance(found->camera.distort(corner), truth.distort(corner)), 1);
  EXPECT_THAT(found->made.lens, HasSubstr("images"));
}

TEST_F(Calibrate, TheTwinsProjectorIsFoundByStructuredLight) {
  // 50 mm beside the camera, which the rig does not know.
  auto truth = calib::reference_rig();
  truth.parallax = {82, 0, 0};
  const auto file = (scratch_.path() / "truth.toml").string();
  std::ofstream(file) << calib::print_calibration(truth);
  const auto outcome =
      calibrate({"screen", "--most-s", "150", "--set", "twin.geometry.calibration=" + file});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  EXPECT_THAT(outcome.log, HasSubstr("5 places of the board"));
  const auto found = calib::load_calibration(scratch_.path() / "twin_calibration.toml");
  ASSERT_TRUE(found) << found.error().what;
  for (const double depth_m : {0.65, 0.8})
    for (const glm::dvec2 px : {glm::dvec2(180, 135), {540, 135}, {180, 405}, {540, 405}})
      EXPECT_LT(glm::distance(found->to_projector(px, depth_m), truth.to_projector(px, depth_m)), 1)
          << px.x << " " << px.y << " at " << depth_m << " m";
}

TEST_F(Calibrate, ARigThatCannotStartIsToldInASentence) {
  const auto outcome = calibrate({"lens", "--set", "camera.rate_hz=-5"});
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.log, HasSubstr("camera.rate_hz"));
  EXPECT_FALSE(fs::exists(scratch_.path() / "twin_calibration.toml"));
}

TEST_F(Calibrate, TheBoardIsPrinted) {
  const auto pdf = (scratch_.path() / "board.pdf").string();
  EXPECT_EQ(handcast({"calibrate", "--print-board", pdf}).exit_code, 0);
  EXPECT_GT(fs::file_size(pdf), 1000u);
}

}  // namespace
}  // namespace handcast::system_test
