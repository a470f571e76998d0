// SPDX-License-Identifier: Apache-2.0
// The calibration in a controller, and the camera model that is made of it.
#include "services/camera/leap/calibration_block.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "services/camera/leap/lens_fit.hpp"
#include "tests/scratch.hpp"
#include "tests/services/camera/leap/sample_calibration.hpp"

namespace handcast::camera::leap {
namespace {

using testing::HasSubstr;

TEST(LeapCalibration, TheBlockOfAControllerIsRead) {
  const auto read = parse_calibration(test::sample_calibration());
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_NEAR(read->baseline_m, 0.04, 1e-9);
  EXPECT_NEAR(read->left.focal_px, 134, 1e-4);
  EXPECT_NEAR(read->left.offset_px.y, 4.3, 1e-5);
  EXPECT_NEAR(read->right.offset_px.x, 0.9, 1e-5);
  EXPECT_NEAR(read->right.radial[3], 1.46, 1e-5);
  EXPECT_NEAR(read->right.rotation.x, 5e-3, 1e-6);
}

TEST(LeapCalibration, AnEmptyMemoryIsNoCalibration) {
  for (const int byte : {0x00, 0xff}) {
    const auto read = parse_calibration(
        std::vector<std::uint8_t>(kCalibrationBytes, static_cast<std::uint8_t>(byte)));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, Errc::bad_data);
    EXPECT_THAT(read.error().what, HasSubstr("distance of the eyes"));
  }
  EXPECT_THAT(parse_calibration({}).error().what, HasSubstr("156 bytes, not 0"));
  auto block = test::sample_calibration();
  put_32(block, 84, 0x7fc00000);
  EXPECT_THAT(parse_calibration(block).error().what, HasSubstr("right eye: focal length is nan"));
}

TEST(LeapCalibration, TheEyesStandTheirDistanceApart) {
  const auto read = parse_calibration(test::sample_calibration());
  const auto pose = right_from_left(*read);
  EXPECT_NEAR(glm::length(glm::dvec3(pose[3])), 0.04, 1e-9);
  EXPECT_LT(pose[3].x, -0.0399) << "what is before the left eye is left of the right eye's axis";
  const glm::dmat3 rotation(pose);
  EXPECT_NEAR(glm::determinant(rotation), 1, 1e-9);
  EXPECT_NEAR(glm::dot(rotation[0], rotation[1]), 0, 1e-9);
}

/// How far the model has an image point from where the controller's calibration has it, seen the
/// other way round: from the image to the ray.
double off_px(const EyeCalibration& eye, const LensFit& fit, glm::dvec2 image_px) {
  const auto& camera = fit.camera;
  const double rows = camera.height_px / 480.;
  const glm::dvec2 image((image_px.x - camera.width_px / 2. - eye.offset_px.x) / eye.focal_px,
                         (image_px.y / rows - 240 - eye.offset_px.y) / eye.focal_px);
  const auto ray = eye.ray_of(image);
  const auto again =
      camera.distort({ray.x * camera.fx_px + camera.cx_px, ray.y * camera.fy_px + camera.cy_px});
  return glm::distance(again, image_px);
}

TEST(LeapLens, OurModelIsNearTheControllersOwn) {
  auto calibration = parse_calibration(test::sample_calibration()).value();
  calibration.left.tangential = {0, 0};
  for (const auto& [width, height] :
       {std::pair(640, 240), std::pair(640, 480), std::pair(752, 240)}) {
    const auto fit = fit_lens(calibration.left, width, height);
    ASSERT_TRUE(fit) << fit.error().what;
    std::printf("%dx%d: rms %.2f px, worst %.2f px, inner half %.2f px\n", width, height,
                fit->rms_px, fit->worst_px, fit->inner_rms_px);
    EXPECT_LT(fit->inner_rms_px, 3.2);
    EXPECT_LT(fit->rms_px, 2);
    EXPECT_NEAR(off_px(calibration.left, *fit, {width / 2., height / 2.}), 0, fit->worst_px + 0.01);
    EXPECT_NEAR(off_px(calibration.left, *fit, {width / 4., height / 3.}), 0, fit->worst_px + 0.01);
    EXPECT_FALSE(fit->camera.folds());
  }
}

TEST(LeapLens, APerfectLensIsFittedExactly) {
  EyeCalibration eye{.focal_px = 400, .offset_px = {3, -2}};
  const auto fit = fit_lens(eye, 640, 480);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->worst_px, 1e-6);
  EXPECT_NEAR(fit->camera.fx_px, 400, 1e-6);
  EXPECT_NEAR(fit->camera.cx_px, 323, 1e-6);
  EXPECT_NEAR(fit->camera.cy_px, 238, 1e-6);
}

TEST(LeapLens, ALensThatFoldsIsSaid) {
  EyeCalibration eye{.focal_px = 134, .radial = {-30, 40, -20, 0, 0, 0}};
  const auto fit = fit_lens(eye, 640, 480);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, Errc::bad_data);
}

TEST(LeapLens, TheCalibrationFileIsRead) {
  const auto calibration = parse_calibration(test::sample_calibration()).value();
  const auto text = calibration_file_of(calibration, "LP53304172541", config::Eye::right, 640, 240);
  ASSERT_TRUE(text) << text.error().what;
  const test::Scratch scratch;
  const auto file = std::filesystem::path(scratch.path()) / "leap.toml";
  std::ofstream(file) << *text;
  const auto read = calib::load_calibration(file);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->camera_device, "LP53304172541");
  EXPECT_EQ(read->camera.height_px, 240);
  EXPECT_NEAR(read->camera.cx_px, 320, 20);
  EXPECT_THAT(read->made.lens, HasSubstr("right eye's"));
  ASSERT_TRUE(read->camera2);
  EXPECT_EQ(read->camera2->camera.height_px, 240);
  EXPECT_NE(read->camera2->camera.cx_px, read->camera.cx_px);
  EXPECT_GT(read->camera2->from_camera[3].x, 0.0399) << "the left eye sees it further to the right";
}

}  // namespace
}  // namespace handcast::camera::leap
