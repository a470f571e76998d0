// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/outbox.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>

#include "ipc/base/clock.hpp"

namespace handcast::desk::osc {
namespace {

constexpr std::size_t kMostChanges = 64;  ///< that are told in one turn; others follow
constexpr std::int64_t kEcho_ns = 300'000'000;
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

Outbox::Outbox(double rate_hz) : period_ns_(seconds_to_ns(1 / rate_hz)) {}

std::vector<std::string> Outbox::packets(const Scene& scene) {
  std::vector<std::string> packets;
  for (const auto& event : scene.events) packets.push_back(write_event(event));
  if (scene.now_ns < due_ns_) return packets;
  due_ns_ = (scene.now_ns - due_ns_ < period_ns_ ? due_ns_ : scene.now_ns) + period_ns_;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const bool is_there = scene.gestures[side].is_there;
    if (is_there || was_there_[side]) packets.push_back(write_hand(scene, side));
    was_there_[side] = is_there;
  }
  return packets;
}

ValueTeller::ValueTeller(const Addresses& addresses, std::string_view host)
    : addresses_(addresses),
      own_source_(fmt::format("osc {}", host)),
      all_(addresses.controls().size()) {}

void ValueTeller::refresh() {
  for (auto& each : all_) each = {};
}

std::vector<std::string> ValueTeller::packets(const Values& values, std::int64_t now_ns) {
  std::vector<std::string> packets;
  const auto count = std::min(all_.size(), values.toml.size());
  for (std::size_t i = 0; i < count; ++i) {
    auto& [seen, told, due_ns] = all_[i];
    const auto& value = values.toml[i];
    if (value != seen) {
      const bool is_own = !seen.empty() && values.source == own_source_;
      due_ns = is_own ? now_ns + kEcho_ns : 0;
      seen = value;
    }
    if (value == told || now_ns < due_ns || packets.size() == kMostChanges) continue;
    told = value;
    packets.push_back(write_value(addresses_.controls()[i], value));
  }
  return packets;
}

void send_all(const std::vector<std::string>& packets, std::span<const int> sockets) {
  for (const int socket : sockets)
    for (const auto& packet : packets)
      // A receiver that is not there is no error.
      (void)::send(socket, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace handcast::desk::osc
