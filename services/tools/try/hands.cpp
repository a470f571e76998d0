// SPDX-License-Identifier: Apache-2.0
#include "services/tools/try/hands.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "renderer/base/joint_math.hpp"

namespace handcast::trial {
namespace {

constexpr int kWrist = 1;

/// True for the joints at which fingers bend: neither metacarpals nor tips.
bool bends(int joint) { return joint > 2 && joint % 5 != 1 && joint % 5 != 0; }

/// The frames of a hand whose fingers are bent by an angle (rad) at each joint, in the space of
/// `wrist`, the frame of its wrist.
renderer::JointFrames bent(const renderer::HandMesh& mesh, const glm::mat4& wrist, float angle) {
  renderer::JointFrames frames;
  frames[kWrist] = wrist;
  for (int joint = 0; joint < renderer::kJoints; ++joint) {
    if (joint == kWrist) continue;
    const auto parent = static_cast<std::size_t>(renderer::kJointParent[joint]);
    frames[joint] = frames[parent] * glm::inverse(mesh.rest[parent]) * mesh.rest[joint];
    if (bends(joint)) frames[joint] = glm::rotate(frames[joint], -angle, {1, 0, 0});
  }
  return frames;
}

msg::HandPose pose_at(const renderer::HandMesh& mesh, float time_s) {
  const float side = mesh.side == renderer::Side::left ? -1 : 1;
  // The back of the hand to the camera, the fingers up.
  glm::mat4 wrist{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0.1f * side, 0.08f, 0.7f, 1}};
  wrist[3].x += 0.02f * std::sin(2 * time_s);
  wrist = glm::rotate(wrist, 0.3f * std::sin(1.3f * time_s), {0, 0, 1});
  const auto frames = bent(mesh, wrist, 0.4f - 0.4f * std::cos(1.7f * time_s));
  msg::HandPose pose;
  pose.side = mesh.side;
  pose.confidence = 1;
  for (std::size_t joint = 0; joint < frames.size(); ++joint)
    renderer::place(pose.joints[joint], frames[joint][3], glm::quat_cast(frames[joint]));
  return pose;
}

}  // namespace

Result<MovingHands> MovingHands::load() {
  const auto rig = config::parse_rig("", "defaults");
  if (!rig) return tl::make_unexpected(rig.error());
  auto calibration = calib::reference_rig();
  calibration.camera_from_tracker = glm::dmat4(1);  // pose_at() is in the space of the camera
  auto hands = content::Hands::load(*rig, calibration);
  if (!hands) return tl::make_unexpected(hands.error());
  return MovingHands(std::move(*hands));
}

content::BothHands MovingHands::at(double time_s) {
  constexpr std::int64_t kBegin_ns = 1'000'000'000;
  msg::HandPoses poses;
  poses.header.origin_ns = poses.header.published_ns = kBegin_ns + seconds_to_ns(time_s);
  for (const auto* mesh : hands_.meshes())
    poses.hands[poses.count++] = pose_at(*mesh, static_cast<float>(time_s));
  hands_.push(poses);
  return hands_.at(poses.header.origin_ns);
}

}  // namespace handcast::trial
