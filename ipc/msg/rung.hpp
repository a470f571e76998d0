// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::msg {

/// The correction that one hand of one frame got, cheapest first (docs/method.md#ladder). Each rung
/// is described in renderer/correct/rung.hpp.
enum class Rung : std::uint8_t { hold, predict, shift, similarity, fingers, landmarks, registered };

/// Number of rungs.
inline constexpr std::size_t kRungs = 7;
/// The names of the rungs in settings and reports, in the order of Rung.
inline constexpr std::array<std::string_view, kRungs> kRungNames{
    "hold", "predict", "shift", "similarity", "fingers", "landmarks", "register"};
/// The name of a rung, from kRungNames.
inline constexpr std::string_view name_of(Rung rung) {
  return kRungNames[static_cast<std::size_t>(rung)];
}

/// `detail` with the rung of one hand added. StageMark::detail has four bits for each side, left
/// lowest: the number of the rung plus 1, or 0 if there is no such hand. The bits of `side` must be
/// 0.
inline constexpr std::uint32_t with_rung(std::uint32_t detail, Side side, Rung rung) {
  return detail | (static_cast<std::uint32_t>(rung) + 1) << 4 * static_cast<std::uint32_t>(side);
}
/// The rung of one hand in StageMark::detail; empty if there is no such hand or the bits are
/// invalid.
inline constexpr std::optional<Rung> rung_in(std::uint32_t detail, Side side) {
  const std::uint32_t number = detail >> 4 * static_cast<std::uint32_t>(side) & 15;
  if (number < 1 || number > kRungs) return std::nullopt;
  return static_cast<Rung>(number - 1);
}

}  // namespace handcast::msg
