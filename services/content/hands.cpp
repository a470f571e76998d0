// SPDX-License-Identifier: Apache-2.0
#include "services/content/hands.hpp"

#include <utility>

#include "renderer/base/joint_math.hpp"
#include "renderer/hand/hand_posture.hpp"
#include "renderer/skin/skinning.hpp"

namespace handcast::content {
namespace {

constexpr int kPalmJoint = 0, kWristJoint = 1;

/// A hand with less is reported, but not seen: it is not drawn, either.
constexpr float kLeastConfidence = 0.1f;
/// The clocks of sensors are not mapped more exactly.
constexpr std::int64_t kEarliest_ns = 50'000'000;
constexpr std::int64_t kSmoothed_ns = 50'000'000;  ///< of the velocity

}  // namespace

void derive(HandState& hand, const glm::vec3& down) {
  const glm::mat3 axes = renderer::palm_axes(hand.joints_m, hand.side);
  const auto posture = renderer::posture_of(hand.joints_m);
  hand.palm_normal = -axes[1];
  hand.gravity = glm::transpose(axes) * glm::normalize(down);
  hand.pinch = posture.pinch;
  hand.spread = posture.spread;
  hand.curl = posture.curl;
}

Result<Hands> Hands::load(const config::Rig& rig, const calib::Calibration& calibration) {
  auto left = renderer::load_hand_or_default(rig.hand.left, Side::left);
  if (!left) return fail_in("left hand", left.error());
  auto right = renderer::load_hand_or_default(rig.hand.right, Side::right);
  if (!right) return fail_in("right hand", right.error());
  return Hands({std::move(*left), std::move(*right)}, rig, calibration);
}

Hands::Hands(std::array<renderer::HandMesh, 2> meshes, const config::Rig& rig,
             const calib::Calibration& calibration)
    : skin_(rig.cascade.skin),
      down_(rig.content.gravity[0], rig.content.gravity[1], rig.content.gravity[2]),
      camera_from_tracker_(calibration.camera_from_tracker) {
  for (auto& mesh : meshes) {
    renderer::BoneFit bone_fit(mesh);
    hands_.push_back({std::move(mesh), renderer::PoseHistory(rig.cascade.predict), bone_fit});
  }
}

void Hands::adjust(const config::Rig& rig) {
  skin_ = rig.cascade.skin;
  const auto& down = rig.content.gravity;
  down_ = {down[0], down[1], down[2]};
  for (Hand& hand : hands_) hand.history.adjust(rig.cascade.predict);
}

void Hands::push(const msg::HandPoses& poses) {
  const std::int64_t origin_ns = poses.header.origin_ns;
  if (origin_ns > poses.header.published_ns + kEarliest_ns) return;
  const auto named =
      sides_.named(poses, {hands_[0].history.at(origin_ns), hands_[1].history.at(origin_ns)});
  for (Hand& hand : hands_) {
    const msg::HandPose* pose = named.find(hand.mesh.side);
    if (!pose || !(pose->confidence >= kLeastConfidence)) continue;
    if (hand.history.push(origin_ns, *pose) != renderer::PoseHistory::Pushed::not_measured)
      hand.bone_fit.learn(origin_ns, renderer::frames_of(*pose));
  }
}

BothHands Hands::both_at(std::int64_t time_ns, std::array<Surface, 2>& surfaces) {
  BothHands both;
  for (std::size_t i = 0; i < both.size(); ++i) {
    const auto pose = hands_[i].history.at(time_ns);
    both[i] = pose ? posed(hands_[i], *pose, surfaces[i]) : resting(hands_[i]);
    if (pose) both[i].velocity_m_s = velocity_m_s(hands_[i], time_ns);
    both[i].mesh = &hands_[i].mesh;
  }
  return both;
}

HandState Hands::resting(const Hand& hand) const {
  const glm::mat4 camera_from_wrist{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0.7f, 1}};
  const glm::mat4 camera_from_model = camera_from_wrist * glm::inverse(hand.mesh.rest[kWristJoint]);
  HandState state;
  state.side = hand.mesh.side;
  for (std::size_t joint = 0; joint < kJoints; ++joint)
    state.joints_m[joint] = glm::vec3(camera_from_model * hand.mesh.rest[joint][3]);
  derive(state, down_);
  return state;
}

HandState Hands::posed(const Hand& hand, const msg::HandPose& pose, Surface& surface) const {
  HandState state;
  state.is_there = true;
  state.side = hand.mesh.side;
  const renderer::JointFrames seen = renderer::frames_of(pose);
  for (std::size_t joint = 0; joint < kJoints; ++joint)
    state.joints_m[joint] = glm::vec3(camera_from_tracker_ * seen[joint][3]);
  derive(state, down_);
  if (!has_surface_) return state;
  renderer::JointFrames frames = skin_.fit ? hand.bone_fit(seen) : seen;
  for (glm::mat4& frame : frames) frame = camera_from_tracker_ * frame;
  surface.positions_m.resize(hand.mesh.vertex_count());
  surface.normals.resize(hand.mesh.vertex_count());
  renderer::skin(hand.mesh, frames, surface.positions_m, surface.normals);
  state.positions_m = surface.positions_m;
  state.normals = surface.normals;
  return state;
}

/// The mean over the last 50 ms, which shows neither the noise of the samples nor a jump.
glm::vec3 Hands::velocity_m_s(const Hand& hand, std::int64_t time_ns) const {
  const auto now = hand.history.at(time_ns), before = hand.history.at(time_ns - kSmoothed_ns);
  if (!now || !before) return glm::vec3(0);
  const glm::vec3 moved_m =
      renderer::position(now->joints[kPalmJoint]) - renderer::position(before->joints[kPalmJoint]);
  return glm::mat3(camera_from_tracker_) * moved_m / (1e-9f * static_cast<float>(kSmoothed_ns));
}

}  // namespace handcast::content
