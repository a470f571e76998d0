// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/tilt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "calib/solve/lens/solve.hpp"

namespace handcast::calib {
namespace {

/// The homography from board space to the image, by least squares; empty if there is none.
cv::Mat map_of(const BoardView& view) {
  constexpr std::size_t kFewest = 4;
  if (view.ids.size() < kFewest) return {};
  const auto points = points_of(view);
  std::vector<cv::Point2d> board_m;
  for (const auto& point : points.board_m) board_m.emplace_back(point.x, point.y);
  try {
    return cv::findHomography(board_m, points.image_px);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

/// The third row of the homography is the distance, up to a factor. It is a linear function of the
/// position on the board, whose gradient the derivative of the homography carries to the image.
std::optional<glm::dvec2> tilt_of(const BoardView& view, double scale_px) {
  const cv::Mat1d map = map_of(view);
  if (map.empty()) return {};
  glm::dvec3 middle(0, 0, 1);
  for (const auto& m : view.board_m)
    middle += glm::dvec3(m.x, m.y, 0) / static_cast<double>(view.board_m.size());
  glm::dmat3 h;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) h[column][row] = map(row, column);
  const auto image = h * middle;
  const glm::dvec2 px = glm::dvec2(image) / image.z;
  const glm::dvec2 growth = glm::dvec2(h[0].z, h[1].z) / image.z;  // per metre
  glm::dmat2 px_per_m;
  for (int axis = 0; axis < 2; ++axis)
    px_per_m[axis] = glm::dvec2(h[axis]) / image.z - px * growth[axis];
  const auto tilt = glm::inverse(glm::transpose(px_per_m)) * growth * scale_px;
  if (!std::isfinite(tilt.x + tilt.y)) return {};
  return tilt;
}

double mistake_of(const BoardView& view) {
  const cv::Mat map = map_of(view);
  if (map.empty()) return std::numeric_limits<double>::infinity();
  const auto points = points_of(view);
  std::vector<cv::Point2d> board_m, expected_px;
  for (const auto& point : points.board_m) board_m.emplace_back(point.x, point.y);
  cv::perspectiveTransform(board_m, expected_px, map);
  double worst = 0;
  for (std::size_t i = 0; i < expected_px.size(); ++i) {
    double pitch_px = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < expected_px.size(); ++j)
      if (j != i) pitch_px = std::min(pitch_px, cv::norm(expected_px[i] - expected_px[j]));
    worst = std::max(worst, cv::norm(expected_px[i] - points.image_px[i]) / pitch_px);
  }
  return std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

}  // namespace handcast::calib
