// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/true_geometry.hpp"

#include <cmath>

#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

const glm::dvec3 kHand_m(0.03, -0.05, 0.73);

glm::dvec2 believed_px(const glm::dvec3& camera_m) {
  const auto rig = calib::reference_rig();
  return rig.projector.pixel_of(rig.camera.project(camera_m));
}

TEST(TrueGeometry, WithoutErrorsIsTheCalibration) {
  const TrueGeometry truth({}, 1, calib::reference_rig());
  EXPECT_LT(glm::distance(truth.to_projector(kHand_m), believed_px(kHand_m)), 1e-9);
  EXPECT_EQ(truth.calibration().camera_from_tracker, calib::reference_rig().camera_from_tracker);
}

TEST(TrueGeometry, AProjectorBesideTheCameraIsRightAtOneDistanceOnly) {
  const TrueGeometry truth({.projector_offset_mm = 10, .plane_mm = 100}, 1, calib::reference_rig());
  const glm::dvec3 on_plane(0.03, -0.05, 0.83);
  EXPECT_LT(glm::distance(truth.to_projector(on_plane), believed_px(on_plane)), 1e-9);
  const double px_per_mm = 1 / calib::reference_rig().mm_per_projector_px(0.73);
  // Similar triangles: 10 mm * (0.83 - 0.73) / 0.83, seen at 0.73 m.
  EXPECT_NEAR(glm::distance(truth.to_projector(kHand_m), believed_px(kHand_m)),
              10 * 0.1 / 0.83 * px_per_mm, 0.02);
}

TEST(TrueGeometry, TheHomographyIsWrongByAsMuchAsAskedInTheCorners) {
  const auto rig = calib::reference_rig();
  double square = 0;
  constexpr int kSeeds = 200;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const TrueGeometry truth({.homography_px = 2}, seed, rig);
    const auto corner = rig.projector.camera_pixel_of({0, 0});
    const auto moved = truth.calibration().projector.pixel_of(corner);
    square += glm::dot(moved, moved);
  }
  EXPECT_NEAR(std::sqrt(square / kSeeds), 2, 0.25);
}

TEST(TrueGeometry, TheTrackerIsWrongByAsMuchAsAskedInTheMiddleOfTheVolume) {
  const auto rig = calib::reference_rig();
  const auto error_m = [&](const config::TwinGeometry& settings, const glm::dvec3& camera_m) {
    const TrueGeometry truth(settings, 1, rig);
    const auto tracker_m = glm::inverse(rig.camera_from_tracker) * glm::dvec4(camera_m, 1);
    return glm::distance(glm::dvec3(truth.calibration().camera_from_tracker * tracker_m), camera_m);
  };
  EXPECT_NEAR(error_m({.tracker_mm = 2, .tracker_deg = 0.3}, {0, 0, 0.73}), 2e-3, 1e-6);
  EXPECT_NEAR(error_m({.tracker_deg = 0.3}, {0, 0, 0.73}), 0, 1e-9);
  EXPECT_GT(error_m({.tracker_deg = 0.3}, {0.2, 0.1, 0.73}), 2e-4);
  EXPECT_LT(error_m({.tracker_deg = 0.3}, {0.2, 0.1, 0.73}), 1.3e-3);
}

TEST(TrueGeometry, TheLensIsWrongInTheCornersAndRightInTheMiddle) {
  const auto rig = calib::reference_rig();
  const TrueGeometry truth({.lens_px = 3}, 1, rig);
  const auto error_px = [&](const glm::dvec2& undistorted_px) {
    return glm::distance(truth.calibration().camera.distort(undistorted_px),
                         rig.camera.distort(undistorted_px));
  };
  EXPECT_NEAR(error_px({0, 0}), 3, 0.3);
  EXPECT_LT(error_px({rig.camera.cx_px + 30, rig.camera.cy_px}), 0.01);
}

TEST(TrueGeometry, TheTwinsLandmarksAreWhatTheTrueCameraSeesAndTheRigUndistorts) {
  auto rig = rig_with("builtin:still");
  const auto right = twin_of(rig)->landmarks(Side::left, 0);
  rig.twin.geometry.lens_px = 10;
  const auto wrong = twin_of(rig)->landmarks(Side::left, 0);
  ASSERT_TRUE(right && wrong);
  float most_px = 0;
  for (std::size_t i = 0; i < right->size(); ++i)
    most_px = std::max(most_px, glm::distance((*right)[i], (*wrong)[i]));
  EXPECT_GT(most_px, 0.05f);
  EXPECT_LT(most_px, 10);
}

}  // namespace
}  // namespace handcast::twin
