// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/finger_bend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "renderer/base/joint_math.hpp"

namespace handcast::renderer {
namespace {

constexpr int kBends = kLandmarksOfFinger - 1;  ///< joints of a finger that bend
constexpr int kRounds = 2;                      ///< steps of Gauss-Newton
constexpr double kSigma_px = 5;                 ///< of a landmark
/// Standard deviations of the tracker's errors: what the joints of a finger share, and each its
/// own.
constexpr double kShared_rad = 0.15, kOwn_rad = 0.08;
constexpr double kMost_rad = 0.6;
constexpr double kNearest_m = 0.05;

/// The joints of a finger from its knuckle to its tip (of the thumb, from its base).
std::array<int, kLandmarksOfFinger> joints_of(int finger) {
  std::array<int, kLandmarksOfFinger> joints{};
  for (int i = 0; i < kLandmarksOfFinger; ++i)
    joints[i] = msg::kJointOfLandmark[first_landmark(finger) + i];
  return joints;
}

/// The axis about which a joint bends: to the right of the finger, WebXR Hand Input, "Skeleton
/// Joints".
glm::vec3 axis_of(const msg::Joint& joint) { return orientation(joint) * glm::vec3(1, 0, 0); }

/// A finger in camera space.
struct SeenFinger {
  std::array<glm::dvec3, kLandmarksOfFinger> at_m;
  std::array<glm::dvec3, kBends> axis;
};

/// Empty if a joint is behind the camera.
std::optional<SeenFinger> see(const msg::HandPose& pose, int finger,
                              const glm::dmat4& camera_from_tracker) {
  SeenFinger seen;
  const auto joints = joints_of(finger);
  for (int i = 0; i < kLandmarksOfFinger; ++i) {
    const msg::Joint& joint = pose.joints[joints[i]];
    seen.at_m[i] = glm::dvec3(camera_from_tracker * glm::dvec4(position(joint), 1));
    if (!(seen.at_m[i].z > kNearest_m)) return std::nullopt;
    if (i < kBends) seen.axis[i] = glm::dmat3(camera_from_tracker) * glm::dvec3(axis_of(joint));
  }
  return seen;
}

glm::dmat3 inverse_prior() {
  glm::dmat3 covariance(kOwn_rad * kOwn_rad);
  for (int i = 0; i < kBends; ++i) covariance[i] += kShared_rad * kShared_rad;
  return glm::inverse(covariance);
}

/// One step towards the bends that are most likely, given those that the finger has.
glm::dvec3 next_bends(const SeenFinger& finger, const glm::vec2* landmarks_px,
                      const calib::CameraModel& camera, const glm::dvec3& bends_rad) {
  static const glm::dmat3 kPrior = inverse_prior();
  constexpr double kWeight = 1 / (kSigma_px * kSigma_px);
  const glm::dvec2 shift_px = glm::dvec2(landmarks_px[0]) - camera.project(finger.at_m[0]);
  glm::dmat3 normal = kPrior;
  glm::dvec3 right = -kPrior * bends_rad;
  for (int i = 1; i < kLandmarksOfFinger; ++i) {
    const glm::dvec2 off_px =
        glm::dvec2(landmarks_px[i]) - camera.project(finger.at_m[i]) - shift_px;
    const glm::dmat3x2 jacobian = camera.jacobian_px_per_m(finger.at_m[i]);
    glm::dmat3x2 px_per_rad(0);
    for (int bend = 0; bend < i; ++bend)
      px_per_rad[bend] =
          jacobian * glm::cross(finger.axis[bend], finger.at_m[i] - finger.at_m[bend]);
    normal += kWeight * (glm::transpose(px_per_rad) * px_per_rad);
    right += kWeight * (glm::transpose(px_per_rad) * off_px);
  }
  const glm::dvec3 next = bends_rad + glm::inverse(normal) * right;
  return glm::clamp(next, glm::dvec3(-kMost_rad), glm::dvec3(kMost_rad));
}

/// Turns each joint, with those beyond it, about its axis.
void bend(msg::HandPose& pose, int finger, const glm::dvec3& by_rad) {
  const auto joints = joints_of(finger);
  for (int k = 0; k < kBends; ++k) {
    const msg::Joint& pivot = pose.joints[joints[k]];
    const glm::vec3 centre = position(pivot);
    const glm::quat turn = glm::angleAxis(static_cast<float>(by_rad[k]), axis_of(pivot));
    for (int i = k; i < kLandmarksOfFinger; ++i) {
      msg::Joint& joint = pose.joints[joints[i]];
      place(joint, centre + turn * (position(joint) - centre), turn * orientation(joint));
    }
  }
}

}  // namespace

msg::HandPose bent(const msg::HandPose& pose, const LandmarkPoints& landmarks_px,
                   const calib::Calibration& calibration) {
  msg::HandPose result = pose;
  for (int finger = 0; finger < kFingers; ++finger) {
    const glm::vec2* const of_finger_px = landmarks_px.data() + first_landmark(finger);
    glm::dvec3 bends_rad(0);
    for (int round = 0; round < kRounds; ++round) {
      const auto seen = see(result, finger, calibration.camera_from_tracker);
      if (!seen) break;
      const glm::dvec3 next_rad = next_bends(*seen, of_finger_px, calibration.camera, bends_rad);
      if (!std::isfinite(next_rad.x + next_rad.y + next_rad.z)) break;
      bend(result, finger, next_rad - bends_rad);
      bends_rad = next_rad;
    }
  }
  return result;
}

}  // namespace handcast::renderer
