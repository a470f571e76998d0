// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/finger_bend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <span>

#include "renderer/base/joint_math.hpp"

namespace handcast::renderer {
namespace {

constexpr int kBends = kLandmarksOfFinger - 1;  ///< joints of a finger that bend
constexpr int kRounds = 2;                      ///< steps of Gauss-Newton
constexpr double kSigma_px = 5, kWeight = 1 / (kSigma_px * kSigma_px);  ///< of a landmark
/// Standard deviations of the tracker's errors: what the joints of a finger share, and each its
/// own.
constexpr double kShared_rad = 0.15, kOwn_rad = 0.08;
constexpr double kMostBend_rad = 0.6;  ///< that a joint is bent by
constexpr double kNearestFinger_m = 0.05;

/// The joints of a finger from its knuckle to its tip (of the thumb, from its base).
using Finger = std::array<msg::Joint, kLandmarksOfFinger>;
using FingerPoints = std::span<const glm::vec2, kLandmarksOfFinger>;

std::size_t joint_of(int finger, int i) {
  return static_cast<std::size_t>(msg::kJointOfLandmark[first_landmark(finger) + i]);
}

/// The axis about which a joint bends: to the right of the finger (WebXR Hand Input, "Skeleton
/// Joints").
glm::vec3 axis_of(const msg::Joint& joint) {
  return glm::normalize(orientation(joint)) * glm::vec3(1, 0, 0);
}

/// Turns each joint, with those beyond it, about its axis.
Finger bent_by(Finger finger, const glm::dvec3& by_rad) {
  for (int k = 0; k < kBends; ++k) {
    const glm::vec3 centre = position(finger[k]);
    const glm::quat turn = glm::angleAxis(static_cast<float>(by_rad[k]), axis_of(finger[k]));
    for (int i = k; i < kLandmarksOfFinger; ++i)
      place(finger[i], centre + turn * (position(finger[i]) - centre),
            turn * orientation(finger[i]));
  }
  return finger;
}

/// A finger as the camera sees it.
struct SeenFinger {
  std::array<glm::dvec3, kLandmarksOfFinger> at_m;    ///< camera space
  std::array<glm::dvec3, kBends> axis;                ///< the same
  std::array<glm::dvec2, kLandmarksOfFinger> off_px;  ///< to the landmarks, without the knuckle's
};

/// Empty if a joint is behind the camera.
std::optional<SeenFinger> see(const Finger& finger, FingerPoints landmarks_px,
                              const calib::Calibration& calibration) {
  SeenFinger seen;
  for (int i = 0; i < kLandmarksOfFinger; ++i) {
    seen.at_m[i] = glm::dvec3(calibration.camera_from_tracker * glm::dvec4(position(finger[i]), 1));
    if (!(seen.at_m[i].z > kNearestFinger_m)) return std::nullopt;
    seen.off_px[i] = glm::dvec2(landmarks_px[i]) - calibration.camera.project(seen.at_m[i]);
    if (!std::isfinite(seen.off_px[i].x + seen.off_px[i].y)) return std::nullopt;
    if (i > 0) seen.off_px[i] -= seen.off_px[0];
    if (i < kBends)
      seen.axis[i] = glm::dmat3(calibration.camera_from_tracker) * glm::dvec3(axis_of(finger[i]));
  }
  return seen;
}

/// The inverse covariance of the bends, 1/rad^2.
const glm::dmat3& prior() {
  static const glm::dmat3 kPrior = [] {
    glm::dmat3 covariance(kOwn_rad * kOwn_rad);
    for (int i = 0; i < kBends; ++i) covariance[i] += kShared_rad * kShared_rad;
    return glm::inverse(covariance);
  }();
  return kPrior;
}

/// The bends that are most likely if the way of the joints is linear in them.
glm::dvec3 most_likely(const SeenFinger& finger, const calib::CameraModel& camera,
                       const glm::dvec3& bends_rad) {
  glm::dmat3 normal = prior();
  glm::dvec3 right = -prior() * bends_rad;
  for (int i = 1; i < kLandmarksOfFinger; ++i) {
    const glm::dmat3x2 jacobian = camera.jacobian_px_per_m(finger.at_m[i]);
    glm::dmat3x2 px_per_rad(0);
    for (int bend = 0; bend < i; ++bend)
      px_per_rad[bend] =
          jacobian * glm::cross(finger.axis[bend], finger.at_m[i] - finger.at_m[bend]);
    normal += kWeight * (glm::transpose(px_per_rad) * px_per_rad);
    right += kWeight * (glm::transpose(px_per_rad) * finger.off_px[i]);
  }
  const glm::dvec3 likely = bends_rad + glm::inverse(normal) * right;
  return glm::clamp(likely, glm::dvec3(-kMostBend_rad), glm::dvec3(kMostBend_rad));
}

/// The finger with its most likely bends, by Gauss-Newton.
Finger fitted(Finger finger, FingerPoints landmarks_px, const calib::Calibration& calibration) {
  glm::dvec3 bends_rad(0);
  for (int round = 0; round < kRounds; ++round) {
    const auto seen = see(finger, landmarks_px, calibration);
    if (!seen) break;
    const glm::dvec3 likely_rad = most_likely(*seen, calibration.camera, bends_rad);
    if (!std::isfinite(likely_rad.x + likely_rad.y + likely_rad.z)) break;
    finger = bent_by(finger, likely_rad - bends_rad);
    bends_rad = likely_rad;
  }
  return finger;
}

}  // namespace

msg::HandPose bent(const msg::HandPose& pose, const LandmarkPoints& landmarks_px,
                   const calib::Calibration& calibration) {
  msg::HandPose result = pose;
  for (int f = 0; f < kFingers; ++f) {
    Finger finger;
    for (int i = 0; i < kLandmarksOfFinger; ++i) finger[i] = pose.joints[joint_of(f, i)];
    finger =
        fitted(finger, FingerPoints(landmarks_px.data() + first_landmark(f), kLandmarksOfFinger),
               calibration);
    for (int i = 0; i < kLandmarksOfFinger; ++i) result.joints[joint_of(f, i)] = finger[i];
  }
  return result;
}

}  // namespace handcast::renderer
