// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/hand_sides.hpp"

#include <cmath>
#include <glm/glm.hpp>

namespace handcast::renderer {
namespace {

using msg::Side;

constexpr std::int64_t kPatience_ns = 400'000'000;
/// Hands closer to their expected places than this are accepted as they are.
constexpr float kFar_m = 0.05f, kFar_px = 60;
/// Sides are exchanged if this share of the distance remains with the sides exchanged.
constexpr float kCloser = 0.3f;

Side other(Side side) { return side == Side::left ? Side::right : Side::left; }

float distance(const msg::HandPose& a, const msg::HandPose& b) {
  float sum_m = 0;
  for (int j = 0; j < msg::kJoints; ++j) {
    const auto &p = a.joints[j].position_m, &q = b.joints[j].position_m;
    sum_m += std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  }
  return sum_m / msg::kJoints;
}

float distance(const msg::HandLandmarks& seen, const LandmarkPoints& expected) {
  float sum_px = 0;
  int count = 0;
  for (int i = 0; i < kLandmarks; ++i) {
    if (!was_seen(seen.points[i])) continue;
    sum_px += glm::distance(position_px(seen.points[i]), expected[i]);
    ++count;
  }
  return count ? sum_px / static_cast<float>(count) : 0.0f;
}

/// Returns true if the hands are far from their own places and much closer to each other's. The
/// distance to an unknown place is taken to be `far` / kCloser.
template <class Message, class Place>
bool exchanged(const Message& reported, const HandSides::BySide<Place>& expected, float far) {
  const auto to_place = [&](const auto& hand, Side side) {
    const auto& place = expected[static_cast<std::size_t>(side)];
    return place ? distance(hand, *place) : far / kCloser;
  };
  float own = 0, crossed = 0;
  for (const Side side : {Side::left, Side::right})
    if (const auto* hand = reported.find(side)) {
      own += to_place(*hand, side);
      crossed += to_place(*hand, other(side));
    }
  return own > far && crossed < kCloser * own;
}

template <class Message>
Message with_sides_exchanged(Message message) {
  for (std::uint32_t i = 0; i < message.count && i < message.hands.size(); ++i)
    message.hands[i].side = other(message.hands[i].side);
  return message;
}

}  // namespace

bool HandSides::Doubt::justified(std::int64_t time_ns, bool exchanged) {
  if (!exchanged) since_ns_.reset();
  if (exchanged && !since_ns_) since_ns_ = time_ns;
  return exchanged && time_ns - *since_ns_ < kPatience_ns;
}

msg::HandPoses HandSides::named(const msg::HandPoses& reported,
                                const BySide<msg::HandPose>& expected) {
  const bool wrong =
      tracker_.justified(reported.header.origin_ns, exchanged(reported, expected, kFar_m));
  return wrong ? with_sides_exchanged(reported) : reported;
}

msg::Landmarks HandSides::named(const msg::Landmarks& reported,
                                const BySide<LandmarkPoints>& expected) {
  const bool wrong =
      detector_.justified(reported.header.origin_ns, exchanged(reported, expected, kFar_px));
  return wrong ? with_sides_exchanged(reported) : reported;
}

}  // namespace handcast::renderer
