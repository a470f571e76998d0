// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/mask/row_spans.hpp"
#include "renderer/mask/run_map.hpp"

namespace handcast::renderer {

/// How far the hands reach in the image, in two bounds: where they are if the bones are where they
/// are thought to be (sure), and where they may be with what the bones may be wrong by (most).
/// Light between the two is hand, unless it goes on beyond both: then some other thing is behind
/// the hand, or there is too much light, and only the inner bound can be trusted; unless much of
/// that is dark: then the bones are off.
class HandMaskBounds {
 public:
  /// The line between a hand and its forearm: light that goes on beyond it says nothing.
  struct Wrist {
    glm::vec2 px, to_elbow;
  };

  /// `shapes`: as many as will be added at most.
  void reset(Rect region, std::size_t shapes);
  void add(std::span<const Flesh> flesh, float sure_px, float most_px, const Wrist& wrist);
  /// The hand may be anywhere in here.
  void add(Rect rect);
  void settle();

  /// Where row `y` is to be looked at, and a little more.
  RowSpan row(int y) const;
  /// All of a run is within the inner bound.
  bool surely_holds(const RunMap::Run& run) const;
  /// Darkens what no hand can be.
  void confine(View<std::uint8_t> mask);

 private:
  void read_around(View<const std::uint8_t> mask);
  double filled(View<const std::uint8_t> mask) const;
  bool goes_beyond(const RunMap::Run& run) const;

  Rect region_;
  RowSpans sure_, most_;
  std::vector<Wrist> wrists_;
  RunMap
      around_;  ///< what is lit outside the inner bound; owner 0: it goes on beyond the outer one
};

}  // namespace handcast::renderer
