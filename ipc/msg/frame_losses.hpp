// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

namespace handcast::msg {

/// Images of a camera that were lost, by reason.
struct FrameLosses {
  std::uint32_t missing = 0;     ///< never arrived: gaps in the camera's numbers
  std::uint32_t incomplete = 0;  ///< arrived without some of their packets
  std::uint32_t underrun = 0;    ///< arrived when no buffer was free
  std::uint32_t skipped = 0;     ///< arrived, but a newer one was there when it could be published
};

/// The losses as a number, StageMark::detail of Stage::capture: 8 bits each, at most 255.
inline constexpr std::uint32_t detail_of(const FrameLosses& lost) {
  const auto byte = [](std::uint32_t count) { return std::min<std::uint32_t>(count, 255); };
  return byte(lost.missing) | byte(lost.incomplete) << 8 | byte(lost.underrun) << 16 |
         byte(lost.skipped) << 24;
}
/// The losses in a number.
inline constexpr FrameLosses losses_in(std::uint32_t detail) {
  return {detail & 0xff, detail >> 8 & 0xff, detail >> 16 & 0xff, detail >> 24};
}

}  // namespace handcast::msg
