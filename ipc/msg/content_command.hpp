// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/header.hpp"
#include "ipc/msg/message_text.hpp"

namespace handcast::msg {

/// The stream of ContentCommand. No service of a rig writes to it: the supervisor gives its ring
/// with the right to write to programs that ask for it.
inline constexpr std::string_view kContentCommands = "content.commands";

/// Another content for one hand or both. The ring keeps the commands, so that a content service
/// that is started again shows what was last asked for.
/// Published by: `handcast content` ("content.commands", with history).  Read by:
/// services/content.
struct ContentCommand {
  static constexpr std::string_view layout = "ContentCommand/1";  ///< see type_hash()

  Header header;                ///< frame_id: number of the command, distinct from all others
  std::uint32_t hands = 0b11;   ///< bit 0: the left hand, bit 1: the right one
  float transition_s = -1;      ///< negative: as in the settings
  MessageText<512> transition;  ///< as content.transition; empty: as in the settings
  MessageText<4096> content;    ///< as content.left

  /// True if the command is for this hand.
  bool is_for(Side side) const { return hands >> static_cast<std::uint32_t>(side) & 1; }
};

/// What is on one hand.
struct ShownContent {
  /// ContentCommand::header.frame_id of the last command for the hand; 0: none.
  std::uint64_t command = 0;
  float draw_ms = 0;           ///< what a picture took, smoothed
  std::uint32_t pictures = 0;  ///< that were published
  MessageText<4096> content;   ///< as content.left
  /// The content of the rig file, which the service begins with.
  MessageText<4096> settings;
  /// Content that was begun and has drawn no picture yet. If the service dies now, this is why.
  MessageText<4096> trying;
  /// Why the last command was refused, or what is wrong with the content; empty if nothing is.
  MessageText<2048> fault;
};

/// What the content service shows.
/// Published by: services/content ("content.state").  Read by: `handcast content`.
struct ContentState {
  static constexpr std::string_view layout = "ContentState/1";  ///< see type_hash()

  Header header;                              ///< frame_id: counted by the service
  std::array<ShownContent, kMaxHands> hands;  ///< left, right
};

}  // namespace handcast::msg
