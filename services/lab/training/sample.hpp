// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "services/landmarks/models/handcast_network.hpp"

namespace handcast::landmarks::training {

/// One training image in the format of handcast-training-images: little-endian, no padding.
/// generated.py reads it.
struct Sample {
  /// `image` is the network's input plus handcast_network::kShownShift, times this, rounded.
  static constexpr float kUnit = 170;

  handcast_network::Places tracker{};  ///< the tracker's joints; they count if has_tracker is 1
  handcast_network::Places truth{};    ///< the labels; may be outside 0..1
  /// The crop in units of 1 / kUnit, row by row.
  std::array<std::uint8_t, handcast_network::kSide_px * handcast_network::kSide_px> image{};
  std::array<std::uint8_t, msg::kLandmarks> visible{};  ///< 1: only its own flesh hides the joint
  std::uint8_t has_tracker = 0;                         ///< 1: the tracker reports a hand
  std::uint8_t has_hand = 0;                            ///< 1: the image shows a hand
  std::uint8_t reserved = 0;                            ///< padding
};
static_assert(sizeof(Sample) ==
              4 * 42 * 2 + handcast_network::kSide_px * handcast_network::kSide_px + 24);

}  // namespace handcast::landmarks::training
