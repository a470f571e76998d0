// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "config/sections/cascade.hpp"
#include "renderer/base/image.hpp"
#include "renderer/mask/hand_mask_bounds.hpp"
#include "renderer/mask/run_map.hpp"

namespace handcast::renderer {

/// Where a hand is expected in the camera image (image px, distorted): picks its component and cuts
/// the forearm off.
struct HandHint {
  Rect region;         ///< of the hand, with a margin for what the prediction may be wrong by
  glm::vec2 wrist_px;  ///< where the hand ends on the forearm (already moved by Mask::forearm_mm)
  glm::vec2 to_elbow;  ///< unit, from there along the forearm
  std::span<const glm::vec2>
      inside_px;  ///< points that are on the hand (joints): seeds of its component
  std::span<const Flesh>
      flesh{};  ///< all that is hand lies in it; empty: the hand may fill its region
  float sure_px = 0, most_px = 0;  ///< what the flesh is usually off by, and at most
};

/// The hand in the camera image: 255 hand, 0 not. Threshold (fixed, or chosen from the image by
/// Otsu on the region's histogram and held between sane bounds), the components that hold the
/// hints' seeds, the forearm cut.
class MaskFinder {
 public:
  explicit MaskFinder(const config::Mask& settings) : settings_(settings) {}

  /// `mask` has the image's size and is written inside the returned rectangle only (the union of
  /// the hints' regions, clipped); no hints, or nothing above the threshold: an empty mask there. A
  /// hint none of whose seeds is on something bright takes the largest bright thing in its region.
  Rect find(GreyView image, std::span<const HandHint> hints, View<std::uint8_t> mask);

  /// Holds all that is lit of one hint's hand in the last mask; empty where nothing is.
  Rect hand_bounds(std::size_t hint) const {
    return hint < kMostHints ? hand_bounds_[hint] : Rect{};
  }
  int threshold() const {
    return threshold_;
  }  ///< used for the last image: a pixel above it may be hand

 private:
  static constexpr std::size_t kMostHints = 8;  ///< more are ignored

  void choose(GreyView image, Rect region);
  void bound(std::span<const HandHint> hints, Rect region);
  void close_holes(View<std::uint8_t> mask);

  config::Mask settings_;
  int threshold_ = 0;
  double smooth_threshold_ = 0;  ///< 0: none chosen yet
  HandMaskBounds reach_;
  RunMap runs_, rest_;  ///< what is bright, and what is not
  std::array<Rect, kMostHints> hand_bounds_{};
};

}  // namespace handcast::renderer
