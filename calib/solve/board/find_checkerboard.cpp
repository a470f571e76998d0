// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "calib/solve/board/find.hpp"

namespace handcast::calib {
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

}  // namespace handcast::calib
