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

/// What is on one hand.
struct ShownContent {
  /// LiveSettings::header.frame_id of the last change that was taken; 0: none.
  std::uint64_t command = 0;
  float draw_ms = 0;           ///< what a picture took, smoothed
  std::uint32_t pictures = 0;  ///< that were published
  MessageText<4096> content;   ///< as content.left
  /// The content of the rig file, which the service begins with.
  MessageText<4096> settings;
  /// Content that was begun and has drawn no picture yet. If the service dies now, this is why.
  MessageText<4096> trying;
  /// Why the last content was refused, or what is wrong with the content; empty if nothing is.
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
