// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/normal.hpp"

#include <array>
#include <opencv2/calib3d.hpp>

namespace handcast::calib {

int free_parameters(Distortion distortion) {
  constexpr std::array kCounts{4, 5, 6, 8, 9};
  return kCounts[static_cast<std::size_t>(distortion)];
}

void move(Pose& pose, const Eigen::VectorXd& by) {
  pose.turn += cv::Vec3d(by[0], by[1], by[2]);
  pose.move += cv::Vec3d(by[3], by[4], by[5]);
}

Seen seen_of(const Points& view, const Pose& pose, const CameraModel& camera) {
  std::vector<cv::Point2d> expected_px;
  cv::Mat1d slopes;
  cv::projectPoints(view.board_m, pose.turn, pose.move, matrix_of(camera), lens_of(camera),
                    expected_px, slopes);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>
      derivatives(slopes.ptr<double>(), slopes.rows, slopes.cols);
  Seen seen{Eigen::VectorXd(slopes.rows), derivatives.leftCols(kPoseNumbers),
            derivatives.middleCols(kPoseNumbers, kLensNumbers)};
  for (Eigen::Index i = 0; i < std::ssize(expected_px); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto off_px = view.image_px[at] - expected_px[at];
    seen.residuals.segment<2>(2 * i) << off_px.x, off_px.y;
  }
  return seen;
}

NormalEquations normal_of(const Points& view, const Pose& pose, const CameraModel& camera,
                          Distortion distortion) {
  const auto seen = seen_of(view, pose, camera);
  Eigen::MatrixXd jacobian(seen.residuals.size(), kPoseNumbers + free_parameters(distortion));
  jacobian << seen.by_pose, seen.by_lens.leftCols(free_parameters(distortion));
  return NormalEquations::of(jacobian, seen.residuals);
}

}  // namespace handcast::calib
