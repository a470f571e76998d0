// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/calib3d.hpp>
#include <random>

#include "calib/calibration.hpp"

namespace handcast::calib {
namespace {

constexpr double kTolerancePx = 1e-6;

TEST(CameraModel, UndistortIsTheInverseOfDistortAllOverTheImage) {
  const auto camera = reference_rig().camera;
  for (int y = 0; y < camera.height_px; y += 7)
    for (int x = 0; x < camera.width_px; x += 7) {
      const glm::dvec2 px(x, y);
      EXPECT_LT(glm::distance(camera.distort(camera.undistort(px)), px), kTolerancePx)
          << x << "," << y;
      EXPECT_LT(glm::distance(camera.undistort(camera.distort(px)), px), kTolerancePx)
          << x << "," << y;
    }
}

TEST(CameraModel, TheReferenceLensMovesPixelsByWhatItsAuthorsMeasured) {
  const auto camera = reference_rig().camera;
  double largest = 0;
  for (int x : {0, 719})
    for (int y : {0, 539})
      largest = std::max(largest, glm::distance(camera.distort({x, y}), {x, y}));
  EXPECT_GT(largest, 5);
  EXPECT_LT(largest, 30);
  EXPECT_LT(glm::distance(camera.distort({359.5, 269.5}), {359.5, 269.5}), 1e-9);
}

TEST(CameraModel, TheJacobianIsTheSlopeOfTheProjection) {
  const auto camera = reference_rig().camera;
  const glm::dvec3 at(0.12, -0.07, 0.65);
  constexpr double kStep_m = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 step(0);
    step[axis] = kStep_m;
    const glm::dvec2 slope =
        (camera.project(at + step) - camera.project(at - step)) / (2 * kStep_m);
    EXPECT_LT(glm::distance(slope, camera.jacobian_px_per_m(at)[axis]), 1e-3) << axis;
  }
}

TEST(CameraModel, ContainsTheAreaOfItsPixels) {
  const CameraModel camera;
  const double right = camera.width_px - 0.5, bottom = camera.height_px - 0.5;
  EXPECT_TRUE(camera.contains({-0.49, -0.49}));
  EXPECT_TRUE(camera.contains({right - 0.01, bottom - 0.01}));
  for (const glm::dvec2 beside :
       {glm::dvec2(-0.51, 9), {9, -0.51}, {right + 0.01, 9}, {9, bottom + 0.01}})
    EXPECT_FALSE(camera.contains(beside)) << beside.x << ", " << beside.y;
  EXPECT_FALSE(camera.contains({std::numeric_limits<double>::quiet_NaN(), 9}));
}

TEST(CameraModel, ProjectsAsOpenCvDoes) {
  const auto camera = reference_rig().camera;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> sideways(-0.12, 0.12), depth(0.4, 0.8);
  std::vector<cv::Point3d> points;
  for (int i = 0; i < 200; ++i)
    points.emplace_back(sideways(random), sideways(random), depth(random));

  const auto k = camera.matrix();
  const cv::Matx33d matrix(k[0][0], k[1][0], k[2][0], k[0][1], k[1][1], k[2][1], k[0][2], k[1][2],
                           k[2][2]);
  const cv::Vec<double, 5> lens(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
  std::vector<cv::Point2d> bent, straight;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), matrix, lens, bent);
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), matrix, cv::noArray(), straight);

  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto px = camera.project({points[i].x, points[i].y, points[i].z});
    EXPECT_LT(glm::distance(px, {straight[i].x, straight[i].y}), kTolerancePx);
    EXPECT_LT(glm::distance(camera.distort(px), {bent[i].x, bent[i].y}), kTolerancePx);
  }
}

}  // namespace
}  // namespace handcast::calib
