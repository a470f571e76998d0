// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/wire_messages.hpp"

#include <algorithm>
#include <string>

namespace handcast::bridge::wire {
namespace {

handcast_wire_HandPose wired(const msg::HandPose& hand) {
  handcast_wire_HandPose wire{};
  wire.side = static_cast<std::uint8_t>(hand.side);
  wire.confidence = hand.confidence;
  for (std::size_t i = 0; i < hand.joints.size(); ++i) {
    const auto& joint = hand.joints[i];
    std::ranges::copy(joint.position_m, wire.joints[i].position_m);
    std::ranges::copy(joint.orientation_xyzw, wire.joints[i].orientation_xyzw);
    wire.joints[i].radius_m = joint.radius_m;
  }
  return wire;
}

handcast_wire_HandLandmarks wired(const msg::HandLandmarks& hand) {
  handcast_wire_HandLandmarks wire{};
  wire.side = static_cast<std::uint8_t>(hand.side);
  wire.presence = hand.presence;
  for (std::size_t i = 0; i < hand.points.size(); ++i) {
    const auto& point = hand.points[i];
    wire.points[i] = {point.x_px, point.y_px, point.confidence, point.sigma_px};
  }
  return wire;
}

msg::HandPose ours(const handcast_wire_HandPose& wire) {
  msg::HandPose hand{.side = static_cast<msg::Side>(wire.side), .confidence = wire.confidence};
  for (std::size_t i = 0; i < hand.joints.size(); ++i) {
    auto& joint = hand.joints[i];
    std::ranges::copy(wire.joints[i].position_m, joint.position_m.begin());
    std::ranges::copy(wire.joints[i].orientation_xyzw, joint.orientation_xyzw.begin());
    joint.radius_m = wire.joints[i].radius_m;
  }
  return hand;
}

msg::HandLandmarks ours(const handcast_wire_HandLandmarks& wire) {
  msg::HandLandmarks hand{.side = static_cast<msg::Side>(wire.side), .presence = wire.presence};
  for (std::size_t i = 0; i < hand.points.size(); ++i) {
    const auto& point = wire.points[i];
    hand.points[i] = {point.x_px, point.y_px, point.confidence, point.sigma_px};
  }
  return hand;
}

handcast_wire_Header header_of(const msg::Header& of, const std::uint8_t* sender,
                               std::string_view name) {
  handcast_wire_Header header{};
  std::copy_n(sender, sizeof header.sender, header.sender);
  header.version = kWireVersion;
  std::copy_n(name.data(), std::min(name.size(), sizeof header.name - 1), header.name);
  header.frame_id = of.frame_id;
  header.origin_ns = of.origin_ns;
  header.published_ns = of.published_ns;
  return header;
}

template <class Message, class Sample>
Message message_with_hands(const Sample& sample) {
  Message message;
  message.header = {sample.header.frame_id, sample.header.origin_ns, sample.header.published_ns};
  message.count = sample.hands._length;  // DDS lets at most two through; check_guest() looks again
  const auto count = std::min<std::size_t>(sample.hands._length, message.hands.size());
  for (std::size_t i = 0; i < count; ++i) message.hands[i] = ours(sample.hands._buffer[i]);
  return message;
}

}  // namespace

template <class Message>
Filled<Message>::Filled(const Message& message, const std::uint8_t* sender, std::string_view name) {
  sample_.header = header_of(message.header, sender, name);
  const auto count = std::min<std::size_t>(message.count, hands_.size());
  for (std::size_t i = 0; i < count; ++i) hands_[i] = wired(message.hands[i]);
  sample_.hands._maximum = static_cast<std::uint32_t>(hands_.size());
  sample_.hands._length = static_cast<std::uint32_t>(count);
  sample_.hands._buffer = hands_.data();
}
template class Filled<msg::HandPoses>;
template class Filled<msg::Landmarks>;

std::unique_ptr<handcast_wire_LiveSettings> filled(const msg::LiveSettings& settings,
                                                   const std::uint8_t* sender,
                                                   std::string_view name) {
  auto sample = std::make_unique<handcast_wire_LiveSettings>();
  sample->header = header_of(settings.header, sender, name);
  const auto values = settings.values.view();
  std::copy_n(values.data(), std::min(values.size(), sizeof sample->values - 1), sample->values);
  return sample;
}

Claim claim_of(const handcast_wire_Header& header) {
  std::string name(text_of(header.name));
  std::ranges::replace_if(
      name, [](char c) { return c < ' ' || c > '~'; }, '?');
  if (name.empty()) name = "?";
  return {.name = std::move(name),
          .version = header.version,
          .origin_ns = header.origin_ns,
          .published_ns = header.published_ns};
}

msg::HandPoses message_of(const handcast_wire_HandPoses& sample) {
  return message_with_hands<msg::HandPoses>(sample);
}
msg::Landmarks message_of(const handcast_wire_Landmarks& sample) {
  return message_with_hands<msg::Landmarks>(sample);
}

}  // namespace handcast::bridge::wire
