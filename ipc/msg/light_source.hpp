// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace handcast::msg {

/// What says when the light of a frame came, the least certain first.
enum class LightSource : std::uint8_t {
  settings,  ///< nobody: a clock by the rate and latency of the settings
  window,    ///< the window system, when it had taken the frame
  kernel,    ///< the kernel, by the time stamp of the refresh
};

/// The names of the sources in reports, in the order of LightSource.
inline constexpr std::array<std::string_view, 3> kLightSourceNames{"settings", "window system",
                                                                   "kernel"};
/// Its name in reports.
inline constexpr std::string_view name_of(LightSource source) {
  return kLightSourceNames[static_cast<std::size_t>(source)];
}

/// What is known of the light of a frame besides its time: StageMark::detail of Stage::light.
struct LightNote {
  LightSource source = LightSource::settings;
  /// Number of refreshes of the output from the frame before to this one: 1 if none was without a
  /// new frame, 0 if it is unknown.
  std::uint32_t refreshes = 0;
};

/// The note as a number: the source in the lowest 8 bits, at most 2^24 - 1 refreshes above.
inline constexpr std::uint32_t detail_of(const LightNote& note) {
  return static_cast<std::uint32_t>(note.source) |
         std::min<std::uint32_t>(note.refreshes, 0xff'ffff) << 8;
}
/// The note in a number; empty if it is invalid.
inline constexpr std::optional<LightNote> light_note_in(std::uint32_t detail) {
  if ((detail & 0xff) >= kLightSourceNames.size()) return std::nullopt;
  return LightNote{static_cast<LightSource>(detail & 0xff), detail >> 8};
}

}  // namespace handcast::msg
