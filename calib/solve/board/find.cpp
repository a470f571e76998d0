// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/find.hpp"

#include <algorithm>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

#include "calib/solve/board/pattern.hpp"

namespace handcast::calib {

std::vector<Found> find_charuco(const Board& board, const cv::Mat1b& image) {
  const auto layout = cv::aruco::CharucoBoard::create(
      board.columns, board.rows, 1, static_cast<float>(kMarkerShare),
      cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_250));
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> marker_ids, ids;
  cv::aruco::detectMarkers(image, layout->dictionary, markers, marker_ids);
  if (marker_ids.empty()) return {};
  std::vector<cv::Point2f> corners;
  cv::aruco::interpolateCornersCharuco(markers, marker_ids, image, layout, corners, ids,
                                       cv::noArray(), cv::noArray(), 1);
  std::vector<Found> found;
  for (std::size_t i = 0; i < corners.size(); ++i) found.push_back({ids[i], corners[i]});
  return found;
}

namespace {

/// The corners as rows from the top left, or half a turn from it; not mirrored.
void unmirror(const cv::Size& size, std::vector<cv::Point2f>& corners) {
  const auto along_row = corners[static_cast<std::size_t>(size.width - 1)] - corners.front();
  const auto down = corners.back() - corners[static_cast<std::size_t>(size.width - 1)];
  if (along_row.cross(down) > 0) return;
  for (int row = 0; row < size.height; ++row) {
    const auto begin = corners.begin() + row * size.width;
    std::reverse(begin, begin + size.width);
  }
}

/// How much brighter the squares are that are white if the corners begin at the top left: the mean
/// difference between neighbours.
double contrast_of(const cv::Size& size, const std::vector<cv::Point2f>& corners,
                   const cv::Mat1b& image) {
  double sum = 0;
  for (int row = 0; row + 1 < size.height; ++row)
    for (int column = 0; column + 1 < size.width; ++column) {
      const auto first = corners.begin() + row * size.width + column;
      const cv::Point middle =
          (first[0] + first[1] + first[size.width] + first[size.width + 1]) / 4;
      sum += image(middle) * ((row + column) % 2 == 0 ? -1. : 1.);
    }
  return sum;
}

}  // namespace

/// The search begins anywhere, so the colours decide which end is the top: the square to the lower
/// right of the first corner is black.
std::vector<Found> find_checkerboard(const Board& board, const cv::Mat1b& image) {
  const cv::Size size(board.columns - 1, board.rows - 1);
  std::vector<cv::Point2f> corners;
  // Its NORMALIZE_IMAGE loses faint boards, its ACCURACY takes longer than refined().
  if (!cv::findChessboardCornersSB(image, size, corners)) return {};
  unmirror(size, corners);
  if (contrast_of(size, corners, image) < 0) std::ranges::reverse(corners);
  std::vector<Found> found;
  for (std::size_t i = 0; i < corners.size(); ++i)
    found.push_back({static_cast<int>(i), corners[i]});
  return found;
}

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
