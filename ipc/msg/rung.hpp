// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::msg {

/// How much of the cascade one hand of one frame was given, cheapest first
/// (renderer/ladder/rung.hpp says what each does).
enum class Rung : std::uint8_t { hold, predict, shift, similarity, fingers, landmarks, registered };

inline constexpr std::size_t kRungs = 7;
inline constexpr std::array<std::string_view, kRungs> kRungNames{
    "hold", "predict", "shift", "similarity", "fingers", "landmarks", "register"};
inline constexpr std::string_view name_of(Rung rung) {
  return kRungNames[static_cast<std::size_t>(rung)];
}

/// The rungs of a frame's hands in StageMark::detail: four bits a side (left lowest) with the
/// rung's number + 1, 0 where that hand is not.
inline constexpr std::uint32_t with_rung(std::uint32_t detail, Side side, Rung rung) {
  return detail | (static_cast<std::uint32_t>(rung) + 1) << 4 * static_cast<std::uint32_t>(side);
}
inline constexpr std::optional<Rung> rung_in(std::uint32_t detail, Side side) {
  const std::uint32_t number = detail >> 4 * static_cast<std::uint32_t>(side) & 15;
  if (number < 1 || number > kRungs) return std::nullopt;
  return static_cast<Rung>(number - 1);
}

}  // namespace handcast::msg
