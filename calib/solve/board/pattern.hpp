// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "calib/solve/board/board.hpp"

namespace handcast::calib {

/// Number of markers of the dictionary, and the side of a marker as a share of a square.
/// @{
constexpr int kMarkers = 250;
constexpr double kMarkerShare = 0.75;
/// @}
/// Radius of a circle as a share of the pitch.
constexpr double kCircleRadius = 0.25;
/// White on each side of the pattern, in squares.
constexpr double kMargin = 0.5;

/// A black rectangle or disc of the pattern, in squares from the pattern's top left corner: x to
/// the right, y down. Shapes do not overlap.
struct Shape {
  glm::dvec2 centre{0}, half_size{0};
  bool round = false;
};

std::vector<Shape> pattern_of(const Board& board);

}  // namespace handcast::calib
