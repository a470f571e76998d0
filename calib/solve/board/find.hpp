// SPDX-License-Identifier: Apache-2.0
/// How the points of each kind of board are found. Images: 8 bits, grey.
#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "calib/solve/board/board.hpp"

namespace handcast::calib {

/// A point of the board in the image.
struct Found {
  int id = 0;
  cv::Point2f image_px;
};

/// Each of them returns an empty list if the board is not there. The corners of squares are a
/// pixel or so off, see refine().
/// @{
std::vector<Found> find_checkerboard(const Board& board, const cv::Mat1b& image);
std::vector<Found> find_circles(const Board& board, const cv::Mat1b& image);
std::vector<Found> find_charuco(const Board& board, const cv::Mat1b& image);
/// @}

/// Those of the points that agree with most of the others; nothing if they are too few or lie along
/// one line, or if some of a board do not agree of which all must be seen.
std::vector<Found> consistent(const Board& board, std::vector<Found> found);

/// Moves the corners of squares to the saddle points of the image, and leaves out those that are
/// then not in line with their neighbours, or covered.
std::vector<Found> refined(const Board& board, const cv::Mat1b& image, std::vector<Found> found);

}  // namespace handcast::calib
