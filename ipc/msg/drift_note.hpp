// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

namespace handcast::msg {

/// Where the tracker seems to be, relative to the calibration (calib::Drift): StageMark::detail of
/// Stage::watch.
struct DriftNote {
  bool moved = false;        ///< beyond doubt, and by more than [pose.drift] allows
  std::uint32_t places = 0;  ///< where hands were held still; 0: nothing is known
  double across_mm = 0;      ///< shift across the camera's axis
  double turn_deg = 0;       ///< angle of the rotation
};

/// The note as a number: 11 bits of 0.1 mm, then 11 bits of 0.01 degrees, 7 bits of places, and
/// whether it moved. Larger values become the largest ones.
inline constexpr std::uint32_t detail_of(const DriftNote& note) {
  constexpr auto steps = [](double value, double step) {
    return value > 0 ? static_cast<std::uint32_t>(std::min(value / step + 0.5, 2047.0)) : 0U;
  };
  return steps(note.across_mm, 0.1) | steps(note.turn_deg, 0.01) << 11 |
         std::min<std::uint32_t>(note.places, 127) << 22 | (note.moved ? 1U : 0U) << 31;
}
/// The note in a number.
inline constexpr DriftNote drift_note_in(std::uint32_t detail) {
  return {(detail >> 31) != 0, detail >> 22 & 127, 0.1 * (detail & 2047),
          0.01 * (detail >> 11 & 2047)};
}

}  // namespace handcast::msg
