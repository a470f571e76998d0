// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// What a bone of the hand is wrapped in, as the image shows it: a disc at either end, and what
/// lies between them.
struct Flesh {
  glm::vec2 from_px, to_px;
  float from_radius_px, to_radius_px;
};

/// Pixels [x0, x1) of a row.
struct RowSpan {
  int x0, x1;
};

/// For every row of a region the parts that a union of shapes covers. Eight rows in a row share
/// theirs.
class RowSpans {
 public:
  /// Empties all rows; no row is given more than `most` spans.
  void reset(Rect region, std::size_t most);
  void add(const Flesh& flesh, float margin_px);
  void add(Rect rect);
  /// Sorts and joins the spans of each row: after the last add(), before row().
  void settle();

  /// From left to right, apart from each other, within the region.
  std::span<const RowSpan> row(int y) const;

 private:
  void add(int band, float x0, float x1);

  Rect region_;
  std::size_t most_ = 0;
  std::vector<RowSpan> spans_;  ///< `most_` places for every eight rows,
  std::vector<int> counts_;     ///< so many of them in use
};

}  // namespace handcast::renderer
