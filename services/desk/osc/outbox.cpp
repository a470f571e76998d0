// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/outbox.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>

#include "ipc/base/clock.hpp"

namespace handcast::desk::osc {
namespace {

constexpr std::size_t kMostChanges = 64;  ///< that are told in one turn; others follow
constexpr std::array<std::string_view, msg::kMaxHands> kSides{"left", "right"};

std::string write_hand(const Scene& scene, std::size_t side) {
  const auto& gesture = scene.gestures[side];
  const auto address = [&](std::string_view name) {
    return fmt::format("/hand/{}/{}", kSides[side], name);
  };
  std::vector<std::string> messages{MessageWriter(address("there")).add(gesture.is_there).packet()};
  if (!gesture.is_there) return write_bundle(messages);
  const std::array<std::pair<std::string_view, float>, 8> amounts{
      {{"pinch", gesture.pinch},
       {"spread", gesture.spread},
       {"fist", gesture.fist},
       {"open", 1 - gesture.fist},
       {"point", static_cast<float>(gesture.is_pointing)},
       {"palm_up", gesture.palm_up},
       {"speed", gesture.speed_m_s},
       {"touch", static_cast<float>(gesture.touches_other)}}};
  for (const auto& [name, amount] : amounts)
    messages.push_back(MessageWriter(address(name)).add(amount).packet());
  MessageWriter joints(address("joints")), places(address("uv"));
  for (const auto& joint : scene.joints_m[side]) joints.add(joint.x).add(joint.y).add(joint.z);
  for (const auto& place : scene.joints_uv[side]) places.add(place.x).add(place.y);
  messages.push_back(joints.packet());
  messages.push_back(places.packet());
  return write_bundle(messages);
}

/// "left.appears" is /event/left/appears.
std::string write_event(std::string_view event) {
  return MessageWriter(address_of(fmt::format("event.{}", event))).add(std::int32_t{1}).packet();
}

}  // namespace

Outbox::Outbox(const Addresses& addresses, double rate_hz)
    : addresses_(addresses),
      period_ns_(seconds_to_ns(1 / rate_hz)),
      told_(addresses.controls().size()) {}

std::vector<std::string> Outbox::packets(const Scene& scene, const Values& values) {
  std::vector<std::string> packets;
  for (const auto& event : scene.events) packets.push_back(write_event(event));
  if (scene.now_ns >= due_ns_) {
    due_ns_ = (scene.now_ns - due_ns_ < period_ns_ ? due_ns_ : scene.now_ns) + period_ns_;
    for (std::size_t side = 0; side < kSides.size(); ++side) {
      const bool is_there = scene.gestures[side].is_there;
      if (is_there || was_there_[side]) packets.push_back(write_hand(scene, side));
      was_there_[side] = is_there;
    }
  }
  add_values(values, packets);
  return packets;
}

void Outbox::add_values(const Values& values, std::vector<std::string>& packets) {
  const auto count = std::min(told_.size(), values.toml.size());
  std::size_t changes = 0;
  for (std::size_t i = 0; i < count && changes < kMostChanges; ++i) {
    if (told_[i] == values.toml[i]) continue;
    told_[i] = values.toml[i];
    packets.push_back(write_value(addresses_.controls()[i], values.toml[i]));
    ++changes;
  }
}

void send_all(const std::vector<std::string>& packets, std::span<const int> sockets) {
  for (const int socket : sockets)
    for (const auto& packet : packets)
      // A receiver that is not there is no error.
      (void)::send(socket, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace handcast::desk::osc
