// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/finger_snaps.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "ipc/base/clock.hpp"
#include "renderer/base/joint_math.hpp"
#include "renderer/predict/projected_pose.hpp"

namespace handcast::renderer {
namespace {

/// From one sample to the next the tip moves by more than this, as seen from the palm, and is so
/// far from where its own motion would have brought it.
constexpr float kStep_m = 0.008f;
/// After a gap of the samples a finger may be anywhere.
constexpr std::int64_t kLongestGap_ns = 50'000'000;
constexpr std::int64_t kLongestSnap_ns = 500'000'000;
/// The landmarks contradict the finger after the step: they are farther from it than this, and
/// nearer to the finger before it by this factor; while it is held, nearer at all.
constexpr float kOff_px = 4, kNearer = 0.35f;

constexpr std::array kPalmLandmarks{0, 5, 9, 13, 17};

int first_joint(int finger) { return 2 + 5 * finger; }

/// The orientation of the palm by the places of wrist and knuckles, which have less noise than the
/// orientations of joints.
glm::quat turn_of_palm(const msg::HandPose& pose) {
  const auto at = [&](int joint) { return position(pose.joints[joint]); };
  const glm::vec3 forward = glm::normalize(at(12) - at(1));
  const glm::vec3 up = glm::normalize(glm::cross(forward, at(22) - at(7)));
  return glm::quat_cast(glm::mat3(glm::cross(forward, up), up, -forward));
}

glm::vec3 tip(const std::array<msg::Joint, 4>& finger) { return position(finger.back()); }

}  // namespace

void FingerSnaps::detection(std::int64_t origin_ns, const msg::HandLandmarks& seen) {
  if (!newest_ || origin_ns >= newest_->origin_ns) newest_ = {origin_ns, seen};
}

msg::HandPose FingerSnaps::held(std::int64_t origin_ns, const msg::HandPose& pose,
                                const LandmarkPoints& moved_px) {
  if (last_ns_ && origin_ns <= *last_ns_) return pose;
  const bool goes_on = last_ns_ && origin_ns - *last_ns_ <= kLongestGap_ns;
  const float since_s = goes_on ? static_cast<float>(ns_to_seconds(origin_ns - *last_ns_)) : 1;
  last_ns_ = origin_ns;
  msg::HandPose result = pose;
  for (int finger = 0; finger < kFingers; ++finger) {
    const Finger now = from_palm(pose, finger);
    const glm::vec3 moved_m = tip(now) - tip(last_[finger]);
    auto& snap = snaps_[finger];
    if (!goes_on) {
      snap.reset();
    } else if (snap) {
      if (origin_ns - snap->since_ns > kLongestSnap_ns ||
          glm::distance(tip(snap->before), tip(now)) < kStep_m ||
          !contradicts(pose, finger, *snap, 1))
        snap.reset();
    } else if (glm::length(moved_m) > kStep_m &&
               glm::length(moved_m - since_s * tip_m_s_[finger]) > kStep_m) {
      snap = Snap{origin_ns, last_[finger], moved_px};
      if (!contradicts(pose, finger, *snap, kNearer)) snap.reset();
    }
    if (snap) result = with_finger(result, finger, snap->before);
    last_[finger] = now;
    tip_m_s_[finger] = goes_on ? moved_m / since_s : glm::vec3(0);
  }
  return result;
}

FingerSnaps::Finger FingerSnaps::from_palm(const msg::HandPose& pose, int finger) {
  const glm::quat to_palm = glm::conjugate(turn_of_palm(pose));
  const glm::vec3 knuckle = position(pose.joints[first_joint(finger)]);
  Finger joints;
  for (int k = 0; k < kFingerJoints; ++k) {
    const msg::Joint& joint = pose.joints[first_joint(finger) + k];
    joints[k] = joint;
    place(joints[k], to_palm * (position(joint) - knuckle), to_palm * orientation(joint));
  }
  return joints;
}

msg::HandPose FingerSnaps::with_finger(msg::HandPose pose, int finger, const Finger& joints) {
  const glm::quat palm = turn_of_palm(pose);
  const glm::vec3 knuckle = position(pose.joints[first_joint(finger)]);
  for (int k = 0; k < kFingerJoints; ++k)
    place(pose.joints[first_joint(finger) + k], knuckle + palm * position(joints[k]),
          palm * orientation(joints[k]));
  return pose;
}

/// True if landmarks that are not older than the snap are nearer to the finger before it than to
/// that of the sample by the factor `nearer`. Both are compared without the offset that the
/// landmarks had before, so that only the step counts.
bool FingerSnaps::contradicts(const msg::HandPose& pose, int finger, const Snap& snap,
                              float nearer) const {
  if (!newest_ || newest_->origin_ns < snap.since_ns) return false;
  const auto now_px = distance_px(pose, finger, snap.moved_px),
             before_px = distance_px(with_finger(pose, finger, snap.before), finger, snap.moved_px);
  return now_px && before_px && *now_px > kOff_px && *before_px < nearer * *now_px;
}

/// RMS of the three outer landmarks, as seen from those of the palm: sample and image are of
/// different times, between which the hand may have moved.
std::optional<float> FingerSnaps::distance_px(const msg::HandPose& pose, int finger,
                                              const LandmarkPoints& moved_px) const {
  const auto points_px = project_landmarks(calibration_, pose);
  if (!points_px) return std::nullopt;
  const auto& seen = newest_->seen.points;
  const auto off_px = [&](int i) { return position_px(seen[i]) - (*points_px)[i] - moved_px[i]; };
  glm::vec2 palm_px{0};
  for (const int i : kPalmLandmarks) {
    if (!was_seen(seen[i])) return std::nullopt;
    palm_px += off_px(i) / static_cast<float>(kPalmLandmarks.size());
  }
  float square_px2 = 0;
  for (int k = 1; k < kLandmarksOfFinger; ++k) {
    const int i = first_landmark(finger) + k;
    if (!was_seen(seen[i])) return std::nullopt;
    const glm::vec2 off = off_px(i) - palm_px;
    square_px2 += glm::dot(off, off) / 3;
  }
  return std::sqrt(square_px2);
}

}  // namespace handcast::renderer
