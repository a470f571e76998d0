// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/draw_board.hpp"

#include <algorithm>
#include <cmath>

#include "calib/solve/board/pattern.hpp"

namespace handcast::calib {
namespace {

/// The share of a pixel that a shape covers; all in pixels from the picture's corner. The edge of a
/// disc is taken for straight within a pixel.
double covered(const Shape& shape, glm::dvec2 pixel_centre) {
  const glm::dvec2 offset = pixel_centre - shape.centre;
  if (shape.round) return std::clamp(shape.half_size.x - glm::length(offset) + 0.5, 0., 1.);
  const auto along =
      glm::min(shape.half_size, offset + 0.5) - glm::max(-shape.half_size, offset - 0.5);
  return std::clamp(along.x, 0., 1.) * std::clamp(along.y, 0., 1.);
}

void paint(const Shape& shape, int width_px, std::vector<double>& black) {
  const glm::ivec2 begin(glm::floor(shape.centre - shape.half_size - 0.5));
  const glm::ivec2 end(glm::ceil(shape.centre + shape.half_size + 0.5));
  for (int y = begin.y; y < end.y; ++y)
    for (int x = begin.x; x < end.x; ++x)
      black[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
            static_cast<std::size_t>(x)] += covered(shape, glm::dvec2(x, y) + 0.5);
}

}  // namespace

GreyPicture draw_board(const Board& board, int px_per_square) {
  GreyPicture picture;
  picture.width_px = (board.columns + 1) * px_per_square;
  picture.height_px = (board.rows + 1) * px_per_square;
  std::vector<double> black(static_cast<std::size_t>(picture.width_px) *
                            static_cast<std::size_t>(picture.height_px));
  for (auto shape : pattern_of(board)) {
    shape.centre = (shape.centre + kMargin) * static_cast<double>(px_per_square);
    shape.half_size *= px_per_square;
    paint(shape, picture.width_px, black);
  }
  picture.pixels.reserve(black.size());
  for (const double share : black)
    picture.pixels.push_back(
        static_cast<std::uint8_t>(std::lround(255 * (1 - std::min(share, 1.)))));
  return picture;
}

}  // namespace handcast::calib
