// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/live_settings.hpp"
#include "services/bridge/gate.hpp"
#include "wire.h"

/// The messages of a rig and those of wire.idl, from which the build makes wire.h.
namespace handcast::bridge::wire {

template <class Message>
struct TypeOf;
template <>
struct TypeOf<msg::HandPoses> {
  using Sample = handcast_wire_HandPoses;
  using Hand = handcast_wire_HandPose;
  static constexpr const char* kStream = "pose.hands";
};
template <>
struct TypeOf<msg::Landmarks> {
  using Sample = handcast_wire_Landmarks;
  using Hand = handcast_wire_HandLandmarks;
  static constexpr const char* kStream = "landmarks.hands";
};

/// A message as it is sent. `sender`: the 16 bytes of the participant. `name`: cut off after 63.
template <class Message>
class Filled {
 public:
  using Sample = typename TypeOf<Message>::Sample;

  Filled(const Message& message, const std::uint8_t* sender, std::string_view name);
  Filled(const Filled&) = delete;
  const Sample* sample() const { return &sample_; }

 private:
  Sample sample_{};
  std::array<typename TypeOf<Message>::Hand, msg::kMaxHands> hands_{};
};

/// Live settings as they are sent.
std::unique_ptr<handcast_wire_LiveSettings> filled(const msg::LiveSettings& settings,
                                                   const std::uint8_t* sender,
                                                   std::string_view name);

/// The text in a member of a sample.
template <std::size_t N>
std::string_view text_of(const char (&text)[N]) {
  return {text, static_cast<std::size_t>(std::find(text, text + N, '\0') - text)};
}

/// What a header says, of which nothing was checked; what is not printable in its name is "?".
Claim claim_of(const handcast_wire_Header& header);

/// A message as it came, with times of the other computer. Numbers may be any: msg::check_guest().
/// @{
msg::HandPoses message_of(const handcast_wire_HandPoses& sample);
msg::Landmarks message_of(const handcast_wire_Landmarks& sample);
/// @}

}  // namespace handcast::bridge::wire
