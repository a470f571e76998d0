// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// The flesh around one bone in the image: a disc at either end and the convex area between them.
struct Flesh {
  /// Centres of the discs, image px.
  /// @{
  glm::vec2 from_px, to_px;
  /// @}
  /// Radii of the discs.
  /// @{
  float from_radius_px, to_radius_px;
  /// @}
};

/// Pixels [x0, x1) of a row.
struct RowSpan {
  /// First column, and one past the last.
  /// @{
  int x0, x1;
  /// @}
};

/// The parts of each row of a region that a union of shapes covers. Each group of eight rows shares
/// the spans at its middle.
class RowSpans {
 public:
  /// Removes all shapes. `most`: spans per row, at most; more are ignored.
  void reset(Rect region, std::size_t most);
  /// Adds the flesh of a bone, grown by `margin_px`.
  void add(const Flesh& flesh, float margin_px);
  /// Adds a rectangle.
  void add(Rect rect);
  /// Sorts and joins the spans of each row: call it after the last add() and before row().
  void settle();

  /// The spans of row `y` of the region, from left to right, with gaps between them.
  std::span<const RowSpan> row(int y) const;

 private:
  void add(int band, float x0, float x1);

  Rect region_;
  std::size_t most_ = 0;
  std::vector<RowSpan> spans_;  ///< `most_` entries per group of rows
  std::vector<int> counts_;     ///< entries in use, per group of rows
};

}  // namespace handcast::renderer
