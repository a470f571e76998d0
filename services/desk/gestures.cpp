// SPDX-License-Identifier: Apache-2.0
#include "services/desk/gestures.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "ipc/base/clock.hpp"
#include "renderer/hand/hand_posture.hpp"

namespace handcast::desk {
namespace {

constexpr float kLeastConfidence = 0.1f;
constexpr std::int64_t kAppears_ns = 100'000'000;  ///< a report for a moment is no hand
constexpr std::int64_t kLeaves_ns = 300'000'000;
constexpr float kSpeedShare = 0.2f;  ///< of the newest sample in the speed
constexpr float kTouch_m = 0.025f, kApart_m = 0.05f;
constexpr int kPalm = 0;

/// The place in the texture of the vertex next to each joint.
std::array<glm::vec2, msg::kJoints> joint_places(const renderer::HandMesh& mesh) {
  std::array<glm::vec2, msg::kJoints> places{};
  for (std::size_t j = 0; j < places.size(); ++j) {
    const glm::vec3 joint(mesh.rest[j][3]);
    const auto nearest = std::ranges::min_element(
        mesh.positions, {}, [&](const glm::vec3& vertex) { return glm::distance(vertex, joint); });
    places[j] = mesh.uv[static_cast<std::size_t>(nearest - mesh.positions.begin())];
  }
  return places;
}

float nearest_m(std::span<const glm::vec3> some, std::span<const glm::vec3> others) {
  float nearest = 1e9f;
  for (const auto& one : some)
    for (const auto& other : others) nearest = std::min(nearest, glm::distance(one, other));
  return nearest;
}

}  // namespace

bool Gestures::Latch::rises(float value, float on, float off) {
  const bool was_on = is_on;
  const float way = on > off ? 1.f : -1.f;
  if (way * value >= way * on) is_on = true;
  if (way * value <= way * off) is_on = false;
  return is_on && !was_on;
}

Gestures::Gestures(const glm::mat4& camera_from_tracker, const glm::vec3& up,
                   const std::array<renderer::HandMesh, msg::kMaxHands>& meshes)
    : camera_from_tracker_(camera_from_tracker), up_(glm::normalize(up)) {
  for (std::size_t hand = 0; hand < meshes.size(); ++hand)
    scene_.joints_uv[hand] = joint_places(meshes[hand]);
}

void Gestures::push(const msg::HandPoses& poses) {
  scene_.poses = poses;
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(poses.count, msg::kMaxHands); ++i)
    if (poses.hands[i].confidence >= kLeastConfidence) see(poses.hands[i], poses.header.origin_ns);
}

void Gestures::see(const msg::HandPose& pose, std::int64_t origin_ns) {
  const auto hand = std::min<std::size_t>(static_cast<std::size_t>(pose.side), 1);
  auto& memory = memories_[hand];
  if (origin_ns <= memory.seen_ns) return;
  auto& joints = scene_.joints_m[hand];
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto& at = pose.joints[j].position_m;
    joints[j] = glm::vec3(camera_from_tracker_ * glm::vec4(at[0], at[1], at[2], 1));
  }
  auto& gesture = scene_.gestures[hand];
  const std::int64_t since_ns = origin_ns - memory.seen_ns;
  const bool is_new = since_ns > kLeaves_ns;
  if (is_new) memory.since_ns = origin_ns;
  const float speed_m_s = glm::distance(joints[kPalm], memory.palm_m) /
                          static_cast<float>(ns_to_seconds(std::max<std::int64_t>(since_ns, 1)));
  gesture.speed_m_s =
      is_new ? 0 : gesture.speed_m_s + kSpeedShare * (speed_m_s - gesture.speed_m_s);
  memory.palm_m = joints[kPalm];
  memory.seen_ns = origin_ns;

  const auto posture = renderer::posture_of(joints);
  gesture.pinch = posture.pinch;
  gesture.spread = posture.spread;
  gesture.fist = posture.curl;
  gesture.palm_up = -glm::dot(renderer::palm_axes(joints, pose.side)[1], up_);
  const float others = std::max({posture.reach[1], posture.reach[2], posture.reach[3]});
  const float points = posture.reach[0] > 0.9f ? 1 - glm::smoothstep(0.6f, 0.85f, others) : 0;
  if (memory.pinch.rises(gesture.pinch, 0.85f, 0.5f)) note(hand, "pinch");
  if (memory.fist.rises(gesture.fist, 0.85f, 0.5f)) note(hand, "fist");
  if (memory.open.rises(gesture.fist, 0.1f, 0.4f)) note(hand, "open");
  if (memory.point.rises(points, 0.8f, 0.3f)) note(hand, "point");
  gesture.is_pointing = memory.point.is_on;
}

void Gestures::note(std::size_t hand, const char* event) {
  if (!scene_.gestures[hand].is_there) return;
  noted_.push_back(std::string(hand == 0 ? "left." : "right.") + event);
}

void Gestures::recognise(std::size_t hand) {
  auto& memory = memories_[hand];
  auto& gesture = scene_.gestures[hand];
  const std::int64_t silent_ns = scene_.now_ns - memory.seen_ns;
  if (!gesture.is_there && silent_ns < kLeaves_ns &&
      memory.seen_ns - memory.since_ns >= kAppears_ns) {
    gesture.is_there = true;
    note(hand, "appears");
  } else if (gesture.is_there && silent_ns > kLeaves_ns) {
    note(hand, "leaves");
    gesture = {};
    memory = {.seen_ns = memory.seen_ns};
  }
  if (gesture.is_there) gesture.absent_s = 0;
}

void Gestures::touch() {
  auto& [left, right] = scene_.gestures;
  const bool are_there = left.is_there && right.is_there;
  const float apart_m = are_there ? nearest_m(scene_.joints_m[0], scene_.joints_m[1]) : 1e9f;
  if (touching_.rises(apart_m, kTouch_m, kApart_m)) noted_.emplace_back("touch");
  left.touches_other = right.touches_other = touching_.is_on;
}

const Scene& Gestures::at(std::int64_t now_ns) {
  const double passed_s = scene_.now_ns == 0 ? 0 : ns_to_seconds(now_ns - scene_.now_ns);
  scene_.now_ns = now_ns;
  for (std::size_t hand = 0; hand < memories_.size(); ++hand) {
    scene_.gestures[hand].absent_s += passed_s;
    recognise(hand);
  }
  touch();
  scene_.events = std::exchange(noted_, {});
  return scene_;
}

}  // namespace handcast::desk
