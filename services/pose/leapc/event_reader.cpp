// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "services/joints/leap_hand.hpp"
#include "services/pose/leapc/connection.hpp"
#include "services/pose/leapc/library.hpp"

namespace handcast::pose::leapc {
namespace {

using joints::LeapHand;

constexpr std::uint32_t kMostHands = 16;
/// A bone whose axes differ more from its direction (cosine) has axes of another meaning.
constexpr double kAlong = 0.9;
constexpr double kShortest_mm = 3;

glm::dvec3 vector(const Vector& v) { return {v.x, v.y, v.z}; }

bool is_finite(const Vector& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_finite(const Bone& bone) {
  const auto& q = bone.rotation;
  return is_finite(bone.root) && is_finite(bone.tip) && std::isfinite(bone.width) &&
         std::isfinite(q.x + q.y + q.z + q.w);
}

bool is_finite(const Hand& hand) {
  return is_finite(hand.palm.normal) && is_finite(hand.palm.direction) && is_finite(hand.arm) &&
         std::isfinite(hand.confidence) && std::ranges::all_of(hand.digits, [](const Digit& digit) {
           return std::ranges::all_of(digit.bones,
                                      [](const Bone& bone) { return is_finite(bone); });
         });
}

/// The axes of a bone. If its rotation contradicts the direction from root to tip, the direction
/// and the palm's normal are taken.
glm::dquat axes_of(const Bone& bone, const Palm& palm) {
  const auto& q = bone.rotation;
  const glm::dquat rotation(q.w, q.x, q.y, q.z);
  const glm::dvec3 way_mm = vector(bone.tip) - vector(bone.root);
  const double length_mm = glm::length(way_mm);
  const bool is_rotation = std::abs(glm::dot(rotation, rotation) - 1) < 0.1;
  const glm::dvec3 to_tip = is_rotation ? rotation * glm::dvec3(0, 0, -1) : glm::dvec3(0);
  const bool fits =
      is_rotation && (length_mm < kShortest_mm || glm::dot(to_tip, way_mm) > kAlong * length_mm);
  const auto axes = fits ? joints::axes_of_bone(to_tip, rotation * glm::dvec3(0, -1, 0))
                         : joints::axes_of_bone(way_mm, vector(palm.normal));
  return axes.value_or(glm::dquat(1, 0, 0, 0));
}

void put(LeapHand& hand, int bone, int root, const Bone& from, const Palm& palm) {
  hand.joint_mm[root] = vector(from.root);
  hand.joint_mm[root + 1] = vector(from.tip);
  hand.axes[bone] = axes_of(from, palm);
  hand.width_mm[bone] = std::clamp(float{from.width}, 0.0f, 200.0f);
}

Result<std::vector<Hand>> hands_of(const TrackingEvent& event) {
  if (event.hand_count > kMostHands)
    return fail(Errc::bad_data,
                fmt::format("a frame with {} hands", std::uint32_t{event.hand_count}));
  std::vector<Hand> hands(event.hand_count);
  if (!hands.empty() && !copy_memory(event.hands, hands.data(), hands.size() * sizeof(Hand)))
    return fail(Errc::bad_data, "a frame whose hands cannot be read");
  return hands;
}

}  // namespace

Result<msg::HandPose> pose_of(const Hand& hand) {
  if (hand.type != 0 && hand.type != 1)
    return fail(Errc::bad_data, "a hand that is neither left nor right");
  if (!is_finite(hand)) return fail(Errc::bad_data, "a hand with a number that is not finite");
  LeapHand leap{.side = hand.type == 0 ? msg::Side::left : msg::Side::right,
                .confidence = std::clamp(float{hand.confidence}, 0.0f, 1.0f)};
  const auto palm = joints::axes_of_bone(vector(hand.palm.direction), vector(hand.palm.normal));
  leap.axes[0] = palm.value_or(glm::dquat(1, 0, 0, 0));
  leap.width_mm[0] = std::clamp(float{hand.arm.width}, 0.0f, 200.0f);
  put(leap, 1, 0, hand.arm, hand.palm);
  for (int f = 0; f < 5; ++f)
    for (int k = 0; k < 4; ++k)
      put(leap, 2 + 4 * f + k, 2 + 8 * f + 2 * k, hand.digits[f].bones[k], hand.palm);
  return joints::rig_hand(leap);
}

Result<Tracked> read_tracking(const Message& message) {
  TrackingEvent event{};
  if (!copy_memory(static_cast<const TrackingEvent*>(message.event), event))
    return fail(Errc::bad_data, "a frame that cannot be read");
  auto hands = hands_of(event);
  if (!hands) return tl::make_unexpected(hands.error());
  std::ranges::stable_sort(*hands, [](const Hand& a, const Hand& b) {
    return std::uint64_t{a.visible_us} > std::uint64_t{b.visible_us};
  });
  Tracked tracked{.frame_id = event.tracking_frame_id, .stamp_us = event.timestamp_us};
  for (const Hand& hand : *hands) {
    const auto pose = pose_of(hand);
    if (!pose) return tl::make_unexpected(pose.error());
    if (!tracked.poses.find(pose->side)) tracked.poses.hands[tracked.poses.count++] = *pose;
  }
  return tracked;
}

}  // namespace handcast::pose::leapc
