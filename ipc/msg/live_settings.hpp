// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "ipc/msg/header.hpp"
#include "ipc/msg/message_text.hpp"

namespace handcast::msg {

/// The stream of LiveSettings. No service of a rig has it for itself: the supervisor gives its ring
/// with the right to write to programs that ask for it, and each change locks it
/// (config::LiveBoard).
inline constexpr std::string_view kLiveSettings = "live.settings";

/// The settings that people have changed while the rig is up: all of them, not what changed last,
/// so that the newest message is the whole truth for a process that starts, and a change is seen
/// whole or not at all.
/// Published by: config::LiveBoard ("live.settings").  Read by: every service.
struct LiveSettings {
  static constexpr std::string_view layout = "LiveSettings/1";  ///< see type_hash()

  Header header;            ///< frame_id: counts the changes
  MessageText<64> source;   ///< who made the last change: "set", "osc 10.0.0.7", "cue 3"
  MessageText<512> change;  ///< what it was: "path=value, path=value", or words
  /// How content that is other by this change comes: as content.transition and _s; empty, negative:
  /// as these say.
  /// @{
  MessageText<512> transition;
  float transition_s = -1;
  std::uint32_t reserved = 0;
  /// @}
  /// Lines "path = value", as TOML: the values that are not those of the rig file.
  MessageText<16384> values;
  /// Values before the last changes, and those that were taken back: each ends with a form feed,
  /// the newest last.
  /// @{
  MessageText<32768> undo, redo;
  /// @}
};

}  // namespace handcast::msg
