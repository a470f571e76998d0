// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace handcast::msg {

/// What StageMark::detail says at Stage::detect.
struct DetectorNote {
  bool is_fallback = false;  ///< landmarks.fallback takes the place of landmarks.backend
};

/// The note as a number, and the note in one.
/// @{
inline constexpr std::uint32_t detail_of(const DetectorNote& note) { return note.is_fallback; }
inline constexpr DetectorNote detector_note_in(std::uint32_t detail) { return {(detail & 1) != 0}; }
/// @}

}  // namespace handcast::msg
