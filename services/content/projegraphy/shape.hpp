// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "services/content/projegraphy/silhouette.hpp"

namespace handcast::projegraphy {

struct Placement;

/// A silhouette for comparisons. Its axes: the centre of the area is the origin, the root of the
/// area is 1, y down.
class Shape {
 public:
  explicit Shape(const Silhouette& silhouette);

  glm::vec2 from_mask(const glm::vec2& px) const { return (px - centre_px_) / unit_px_; }
  glm::vec2 to_mask(const glm::vec2& at) const { return at * unit_px_ + centre_px_; }

  /// The root of the area.
  float unit_px() const { return unit_px_; }

  /// The mean distance of the outlines of this shape and of another one that is placed on it,
  /// among parts of the same direction, 0..kFarthest, from both sides.
  float distance_of(const Shape& other, const Placement& placement) const;
  /// The share of the joint area that both cover.
  float overlap_of(const Shape& other, const Placement& placement) const;

 private:
  static constexpr int kCells = 96;          ///< of a side of a grid
  static constexpr float kReach = 2.2f;      ///< half the side of a grid
  static constexpr float kFarthest = 0.22f;  ///< beyond which outlines have nothing in common
  static constexpr int kDirections = 4;
  struct Point {
    glm::vec2 at;
    float angle_rad;  ///< of the outward normal
  };
  using Grid = renderer::Image<float>;

  void find_outline(const Silhouette& silhouette);
  void find_distances();
  static glm::ivec2 cell_of(const glm::vec2& at);
  float distance_at(const glm::vec2& at, float angle_rad) const;

  glm::vec2 centre_px_{0};
  float unit_px_ = 1;
  std::vector<Point> outline_;               ///< at most 2 * kPoints
  std::array<Grid, kDirections> distances_;  ///< to the outline of about this direction
  renderer::Image<std::uint8_t> area_;
};

}  // namespace handcast::projegraphy
