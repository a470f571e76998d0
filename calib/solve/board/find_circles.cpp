// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

#include "calib/solve/board/find.hpp"
#include "calib/solve/board/pattern.hpp"

namespace handcast::calib {
namespace {

/// More blobs than this for each circle are noise, among which the search for a grid takes minutes.
constexpr std::size_t kMostBlobs = 3;

/// The middles of round dark blobs.
std::vector<cv::Point2f> blobs(const cv::Mat1b& image) {
  constexpr float kSmallest_px2 = 12, kLargestShare = 0.02F;  // of the image
  cv::SimpleBlobDetector::Params wanted;
  wanted.minArea = kSmallest_px2;
  wanted.maxArea = kLargestShare * static_cast<float>(image.total());
  wanted.minDistBetweenBlobs = 4;
  wanted.minThreshold = wanted.thresholdStep = 5;  // for boards of little contrast
  std::vector<cv::KeyPoint> found;
  cv::SimpleBlobDetector::create(wanted)->detect(image, found);
  std::vector<cv::Point2f> middles;
  cv::KeyPoint::convert(found, middles);
  return middles;
}

/// Puts the rows in the order in which the board is upright, or nearly so.
void turn_upright(const cv::Size& size, std::vector<cv::Point2f>& centres) {
  const auto along_row = centres[static_cast<std::size_t>(size.width - 1)] - centres.front();
  const auto down = centres.back() - centres[static_cast<std::size_t>(size.width - 1)];
  if (along_row.cross(down) < 0)
    for (int row = 0; row < size.height; ++row) {
      const auto begin = centres.begin() + row * size.width;
      std::reverse(begin, begin + size.width);
    }
  if (centres[static_cast<std::size_t>(size.width - 1)].x < centres.front().x)
    std::ranges::reverse(centres);
}

/// How far the image of a circle has its middle from the image of the circle's centre. `image`:
/// homography from pitches to pixels. The middle of a conic is the pole of the line at infinity
/// (Hartley and Zisserman, Multiple View Geometry, 2.2.3 and 8.3).
cv::Point2f shift_of(const cv::Matx33d& image, cv::Point2f circle) {
  const double r2 = kCircleRadius * kCircleRadius;
  const cv::Matx33d move(1, 0, circle.x, 0, 1, circle.y, 0, 0, 1);
  const auto centre = image * move * cv::Vec3d(0, 0, 1);
  const auto map = image * move;
  const auto middle = map * cv::Matx33d::diag({r2, r2, -1}) * map.t() * cv::Vec3d(0, 0, 1);
  return {static_cast<float>(middle[0] / middle[2] - centre[0] / centre[2]),
          static_cast<float>(middle[1] / middle[2] - centre[1] / centre[2])};
}

}  // namespace

std::vector<Found> find_circles(const Board& board, const cv::Mat1b& image) {
  const cv::Size size(board.columns, board.rows);
  const auto candidates = blobs(image);
  if (candidates.size() > kMostBlobs * static_cast<std::size_t>(size.area())) return {};
  std::vector<cv::Point2f> centres;
  constexpr int kGrid = cv::CALIB_CB_SYMMETRIC_GRID;
  if (!cv::findCirclesGrid(candidates, size, centres, kGrid, nullptr) &&
      !cv::findCirclesGrid(candidates, size, centres, kGrid | cv::CALIB_CB_CLUSTERING, nullptr))
    return {};
  turn_upright(size, centres);
  std::vector<cv::Point2f> grid;
  grid.reserve(centres.size());
  for (int row = 0; row < size.height; ++row)
    for (int column = 0; column < size.width; ++column) grid.emplace_back(column, row);
  const cv::Matx33d map = cv::findHomography(grid, centres);
  std::vector<Found> found;
  for (std::size_t i = 0; i < centres.size(); ++i)
    found.push_back({static_cast<int>(i), centres[i] - shift_of(map, grid[i])});
  return found;
}

}  // namespace handcast::calib
