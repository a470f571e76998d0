// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "config/sections/cascade.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/hand/hand_mesh.hpp"

/// @file
/// Step "correct": moves the drawing from P onto Q̂. All points are in projector px. See
/// `docs/method.md#correct`.

namespace handcast::renderer {

/// Moving least squares with similarities (Schaefer et al. 2006, section 2.2): a smooth deformation
/// that maps the control points p to q, with weights |p - v|^(-2 alpha) at a point v. See also
/// paper, "Moving Least Squares Deformation".
class MovingLeastSquares {
 public:
  /// The largest number of control points: the landmarks of two hands.
  static constexpr std::size_t kMost = 2 * kLandmarks;
  /// Copies the control points, of the same number, at most kMost. Without any, nothing is moved;
  /// if all `p` are within half a pixel of their mean, everything is translated.
  MovingLeastSquares(std::span<const glm::vec2> p, std::span<const glm::vec2> q, float alpha);
  /// The image of `v`.
  glm::vec2 operator()(glm::vec2 v) const;
  /// Moves all `points` in place; vectorised.
  void apply(std::span<glm::vec2> points) const;

 private:
  std::array<glm::vec2, kMost> p_, q_;
  std::size_t count_;
  float alpha_;
};

/// A regular grid over an image, with moved nodes: a piecewise linear warp. Each cell is split
/// along its diagonal from the top left to the bottom right.
struct WarpGrid {
  /// Number of nodes, at least 2 x 2.
  /// @{
  int columns = 0, rows = 0;
  /// @}
  Rect area;                     ///< area of the grid at rest, corner nodes at its corner pixels
  std::vector<glm::vec2> nodes;  ///< moved positions, row by row

  /// The position of a node at rest.
  glm::vec2 source(int column, int row) const;
  /// The image of `v`. Outside the area: by the nearest cell.
  glm::vec2 operator()(glm::vec2 v) const;
};

/// Replaces `grid` by that of the paper's correction: grid_columns x grid_rows nodes over `area`,
/// moved by `field`. Its memory is reused.
void make_warp_grid(const config::Correct& settings, Rect area, const MovingLeastSquares& field,
                    WarpGrid& grid);

/// The default correction: moves the vertices of one drawn hand in place, by one similarity per
/// bone from `p` (P) to `q` (Q̂), blended with the skin weights. A bone seen shorter than
/// bone_long_px hands over to moving least squares, completely at bone_short_px. `vertices`: one
/// per vertex of `hand`.
void correct_vertices(const config::Correct& settings, const HandMesh& hand,
                      std::span<const glm::vec2, kLandmarks> p,
                      std::span<const glm::vec2, kLandmarks> q, std::span<glm::vec2> vertices);

}  // namespace handcast::renderer
