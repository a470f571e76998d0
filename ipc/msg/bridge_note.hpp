// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

namespace handcast::msg {

/// What the bridge knows of a message that came from another computer: StageMark::detail of
/// Stage::bridge, which lasts from the message's publication there, on our clock, to that here.
struct BridgeNote {
  double clock_error_us = 0;  ///< half the width of the interval in which their clock must lie
  std::uint64_t refused = 0;  ///< messages that were not used, since the start of the bridge
};

/// The note as a number: 16 bits of 2 us, then 16 bits of messages. Larger values become the
/// largest ones.
inline constexpr std::uint32_t detail_of(const BridgeNote& note) {
  const double steps = std::clamp(note.clock_error_us / 2 + 0.5, 0.0, 65535.0);
  return static_cast<std::uint32_t>(steps) |
         static_cast<std::uint32_t>(std::min<std::uint64_t>(note.refused, 65535)) << 16;
}
/// The note in a number.
inline constexpr BridgeNote bridge_note_in(std::uint32_t detail) {
  return {2.0 * (detail & 65535), detail >> 16};
}

}  // namespace handcast::msg
