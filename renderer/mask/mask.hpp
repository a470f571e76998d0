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
#include "renderer/mask/local_threshold.hpp"
#include "renderer/mask/run_map.hpp"

namespace handcast::renderer {

/// Where a hand is expected in the camera image (image px, distorted). Selects its connected part
/// and cuts the forearm off. The spans are borrowed.
struct HandHint {
  Rect region;         ///< bounds of the hand, with a margin for errors of the prediction
  glm::vec2 wrist_px;  ///< where the hand ends on the forearm, config::Mask::forearm_mm included
  glm::vec2 to_elbow;  ///< unit, from `wrist_px` along the forearm
  /// Points on the hand (its joints): the seeds of its connected part.
  std::span<const glm::vec2> inside_px;
  /// Contains the whole hand. Empty: the hand may fill its region.
  std::span<const Flesh> flesh{};
  /// Usual and largest error of the flesh.
  /// @{
  float sure_px = 0, most_px = 0;
  /// @}
};

/// Finds the hands in a camera image: pixels above a threshold, inside the bounds of the hands, in
/// a connected part that contains a seed, without the forearm, small holes closed. The threshold is
/// fixed or chosen from each image (choose_threshold()), limited and smoothed, and then follows the
/// light over the hand (LocalThreshold). One thread.
class MaskFinder {
 public:
  /// Copies the settings.
  explicit MaskFinder(const config::Mask& settings) : settings_(settings) {}

  /// Writes the mask of all hands: 255 hand, 0 not. `mask` has the size of the image; only the
  /// returned rectangle is written, the joined regions of the hints, clipped to the image. A hint
  /// without a seed on a bright part takes the largest bright part in its region. At most eight
  /// hints are used.
  Rect find(GreyView image, std::span<const HandHint> hints, View<std::uint8_t> mask);

  /// Bounds of the hand of one hint in the last mask; empty if there is none.
  Rect hand_bounds(std::size_t hint) const {
    return hint < kMostHints ? hand_bounds_[hint] : Rect{};
  }
  /// The threshold of the last image. A chosen one is the middle of those of the pixels.
  int threshold() const { return threshold_; }
  /// The thresholds of the pixels in the last image; null if one holds for all.
  const LocalThreshold* local_threshold() const {
    return settings_.threshold <= 0 ? &local_ : nullptr;
  }

 private:
  static constexpr std::size_t kMostHints = 8;

  void choose(GreyView image, Rect region);
  void binarise(GreyView image, Rect region, View<std::uint8_t> mask);
  void bound(std::span<const HandHint> hints, Rect region);
  void close_holes(View<std::uint8_t> mask);

  config::Mask settings_;
  int threshold_ = 0;
  double smooth_threshold_ = 0;  ///< 0 until one is chosen
  LocalThreshold local_;
  HandMaskBounds reach_;
  RunMap runs_, rest_;  ///< the bright and the dark parts
  std::array<Rect, kMostHints> hand_bounds_{};
};

}  // namespace handcast::renderer
