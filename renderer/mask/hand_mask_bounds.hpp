// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/mask/row_spans.hpp"
#include "renderer/mask/run_map.hpp"

namespace handcast::renderer {

/// Bounds of the hands in the image, from the flesh around their bones. The inner bound is where
/// the hands are if the bones are where they are expected; the outer bound is where they may be if
/// the bones are off. Lit pixels between the two are hand, unless they continue beyond the outer
/// bound: then something else is lit behind the hand, or the image is too bright, and only the
/// inner bound counts. If no more than 85 % of the inner bound is lit, the bones are off, and
/// everything up to the outer bound counts. One thread.
class HandMaskBounds {
 public:
  /// The line between a hand and its forearm. Lit pixels beyond it are the arm and do not count as
  /// continuing beyond the outer bound.
  struct Wrist {
    glm::vec2 px;        ///< a point of the line, image px
    glm::vec2 to_elbow;  ///< unit, at right angles to the line
  };

  /// Removes all hands. `region`: image px. `shapes`: the number of shapes that will be added, at
  /// most.
  void reset(Rect region, std::size_t shapes);
  /// Adds a hand by its flesh, which grows by `sure_px` for the inner and by `most_px` for the
  /// outer bound.
  void add(std::span<const Flesh> flesh, float sure_px, float most_px, const Wrist& wrist);
  /// Adds a rectangle that a hand may fill, to both bounds.
  void add(Rect rect);
  /// Ends the additions: call it after the last add() and before the functions below.
  void settle();

  /// The part of row `y` inside the outer bound, and 2 px on either side.
  RowSpan row(int y) const;
  /// True if the whole run is inside the inner bound.
  bool surely_holds(const RunMap::Run& run) const;
  /// Sets the pixels of `mask` (0 or 255) to 0 that cannot be hand.
  void confine(View<std::uint8_t> mask);

 private:
  void read_around(View<const std::uint8_t> mask);
  double filled(View<const std::uint8_t> mask) const;
  bool goes_beyond(const RunMap::Run& run) const;

  Rect region_;
  RowSpans sure_, most_;
  std::vector<Wrist> wrists_;
  /// Lit parts outside the inner bound. Owner 0: the part continues beyond the outer bound.
  RunMap around_;
};

}  // namespace handcast::renderer
