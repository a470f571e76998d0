// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/normal.hpp"

#include <array>
#include <opencv2/calib3d.hpp>

namespace handcast::calib {
namespace {

constexpr int kPose = 6, kLens = 9;

cv::Mat1d residuals_of(const Points& view, const std::vector<cv::Point2d>& expected_px) {
  cv::Mat1d residuals(2 * static_cast<int>(expected_px.size()), 1);
  auto value = residuals.begin();
  for (std::size_t i = 0; i < expected_px.size(); ++i) {
    *value++ = view.image_px[i].x - expected_px[i].x;
    *value++ = view.image_px[i].y - expected_px[i].y;
  }
  return residuals;
}

}  // namespace

int free_parameters(Distortion distortion) {
  constexpr std::array kCounts{4, 5, 6, 8, 9};
  return kCounts[static_cast<std::size_t>(distortion)];
}

Normal normal_of(const Points& view, const Pose& pose, const CameraModel& camera,
                 Distortion distortion) {
  std::vector<cv::Point2d> expected_px;
  cv::Mat slopes;
  cv::projectPoints(view.board_m, pose.turn, pose.move, matrix_of(camera), lens_of(camera),
                    expected_px, slopes);
  const auto residuals = residuals_of(view, expected_px);
  const cv::Mat1d fixed = slopes.colRange(0, kPose + kLens);
  slopes.colRange(kPose + free_parameters(distortion), kPose + kLens) = 0;
  cv::Mat1d products;
  cv::mulTransposed(fixed, products, true);
  const cv::Mat1d slope = fixed.t() * residuals;

  Normal normal;
  normal.pose = products(cv::Rect(0, 0, kPose, kPose));
  normal.mixed = products(cv::Rect(kPose, 0, kLens, kPose));
  normal.lens = products(cv::Rect(kPose, kPose, kLens, kLens));
  for (int i = free_parameters(distortion); i < kLens; ++i) normal.lens(i, i) = 1;
  for (int i = 0; i < kPose; ++i) normal.pose_slope[i] = slope(i);
  for (int i = 0; i < kLens; ++i) normal.lens_slope[i] = slope(kPose + i);
  normal.squares = residuals.dot(residuals);
  return normal;
}

Statement statement_of(const Normal& normal) {
  const cv::Matx<double, 6, 9> followed = normal.pose.solve(normal.mixed, cv::DECOMP_CHOLESKY);
  return {normal.lens - normal.mixed.t() * followed,
          normal.lens_slope - LensVector(followed.t() * normal.pose_slope)};
}

PoseVector pose_step(const Normal& normal, const LensVector& lens_step) {
  const PoseVector rest = normal.pose_slope - PoseVector(normal.mixed * lens_step);
  return normal.pose.solve(rest, cv::DECOMP_CHOLESKY);
}

LensVector values_of(const CameraModel& c) {
  return {c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3};
}

CameraModel camera_of(const LensVector& values, int width_px, int height_px) {
  return {.width_px = width_px,
          .height_px = height_px,
          .fx_px = values[0],
          .fy_px = values[1],
          .cx_px = values[2],
          .cy_px = values[3],
          .k1 = values[4],
          .k2 = values[5],
          .p1 = values[6],
          .p2 = values[7],
          .k3 = values[8]};
}

}  // namespace handcast::calib
