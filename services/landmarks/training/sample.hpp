// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "services/landmarks/models/handcast_network.hpp"

namespace handcast::landmarks::training {

/// One training image as the program writes it: little-endian, no padding. generated.py reads the
/// same.
struct Sample {
  static constexpr float kUnit =
      170;  ///< `image` is (shown value + handcast_network::kShownShift) times this, rounded

  handcast_network::Places tracker{};  ///< the tracker's joints as it reports them; see has_tracker
  handcast_network::Places truth{};    ///< places in the crop, 0..1, may lie outside
  std::array<std::uint8_t, handcast_network::kSide_px * handcast_network::kSide_px> image{};
  std::array<std::uint8_t, msg::kLandmarks>
      visible{};  ///< nothing lies before the joint but its own flesh
  std::uint8_t has_tracker = 0;
  std::uint8_t has_hand = 0;
  std::uint8_t reserved = 0;
};
static_assert(sizeof(Sample) ==
              4 * 42 * 2 + handcast_network::kSide_px * handcast_network::kSide_px + 24);

}  // namespace handcast::landmarks::training
