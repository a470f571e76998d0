// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/articulated_hand.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "renderer/base/joint_math.hpp"

namespace handcast::renderer {
namespace {

constexpr std::size_t kWristOfHand = 1;

/// The rotation by a rotation vector.
glm::dmat3 rotation_by(const glm::dvec3& vector_rad) {
  const double angle_rad = glm::length(vector_rad);
  if (angle_rad < 1e-12) return glm::dmat3(1);
  return glm::dmat3(glm::mat3_cast(glm::angleAxis(angle_rad, vector_rad / angle_rad)));
}

/// The joints of a finger from the one below its knuckle.
std::array<std::size_t, kLandmarksOfFinger + 1> chain_of(int finger) {
  const auto knuckle = joint_of_landmark(first_landmark(finger));
  return {finger == 0 ? kWristOfHand : knuckle - 1, knuckle, knuckle + 1, knuckle + 2, knuckle + 3};
}

}  // namespace

HandJoints in_camera(const calib::Calibration& calibration, const msg::HandPose& pose) {
  const glm::dmat4& camera_from_tracker = calibration.camera_from_tracker;
  HandJoints joints;
  for (std::size_t j = 0; j < joints.at_m.size(); ++j) {
    joints.at_m[j] = glm::dvec3(camera_from_tracker * glm::dvec4(position(pose.joints[j]), 1));
    joints.axes[j] = glm::dmat3(camera_from_tracker) *
                     glm::mat3_cast(glm::normalize(glm::dquat(orientation(pose.joints[j]))));
  }
  return joints;
}

msg::HandPose in_tracker(const calib::Calibration& calibration, const HandJoints& joints,
                         msg::HandPose pose) {
  const glm::dmat4 tracker_from_camera = glm::inverse(calibration.camera_from_tracker);
  for (std::size_t j = 0; j < joints.at_m.size(); ++j)
    place(pose.joints[j], glm::vec3(tracker_from_camera * glm::dvec4(joints.at_m[j], 1)),
          glm::quat(
              glm::normalize(glm::quat_cast(glm::dmat3(tracker_from_camera) * joints.axes[j]))));
  return pose;
}

Flexions flexions_of(const HandJoints& joints) {
  Flexions flexions{};
  for (int finger = 0; finger < kFingers; ++finger) {
    const auto chain = chain_of(finger);
    const auto bone_m = [&](int i) { return joints.at_m[chain[i + 1]] - joints.at_m[chain[i]]; };
    // The angle at the thumb's root is its place on the hand.
    for (int i = finger == 0 ? 1 : 0; i < kBendsOfFinger; ++i)
      flexions[finger][i] = std::atan2(
          glm::dot(glm::cross(bone_m(i), bone_m(i + 1)), bend_axis(joints, chain[i + 1])),
          glm::dot(bone_m(i), bone_m(i + 1)));  // 0 without a bone
  }
  return flexions;
}

ArticulatedHand::ArticulatedHand(const HandJoints& reported, const HandErrors& errors)
    : reported_(reported), joints_(reported), flexions_(flexions_of(reported)) {
  for (int landmark = 0; landmark < kLandmarks; ++landmark) {
    const auto joint = joint_of_landmark(landmark);
    joints_.at_m[joint] += reported.axes[joint] * vector_at(errors, error::place_of(landmark));
  }
  for (int finger = 0; finger < kFingers; ++finger) bend(finger, errors);
  place(errors);
}

/// Turns a finger about its knuckle sideways, and each joint with those beyond it.
void ArticulatedHand::bend(int finger, const HandErrors& errors) {
  const auto knuckle = joint_of_landmark(first_landmark(finger));
  const auto turn_from = [&](std::size_t first, const glm::dvec3& axis, double angle_rad) {
    const glm::dmat3 turn = rotation_by(axis * angle_rad);
    const glm::dvec3 centre = joints_.at_m[first];
    for (std::size_t j = first; j < knuckle + kLandmarksOfFinger; ++j) {
      joints_.at_m[j] = centre + turn * (joints_.at_m[j] - centre);
      joints_.axes[j] = turn * joints_.axes[j];
    }
  };
  auto& axis = axis_[finger];
  axis[kBendsOfFinger] = joints_.axes[knuckle][1];
  turn_from(knuckle, axis[kBendsOfFinger], errors[error::spread_of(finger)]);
  for (int b = 0; b < kBendsOfFinger; ++b) {
    const auto joint = knuckle + static_cast<std::size_t>(b);
    axis[b] = bend_axis(joints_, joint);
    turn_from(joint, axis[b],
              errors[error::bend_of(finger, b)] +
                  errors[error::missing_of(finger)] * flexions_[finger][b]);
  }
}

/// Turns, scales and shifts the hand about its wrist. Then displaces the joints by their drift.
void ArticulatedHand::place(const HandErrors& errors) {
  const glm::dmat3 turn = rotation_by(vector_at(errors, error::kTurn));
  whole_ = std::exp(errors[error::kSize]) * turn;
  wrist_m_ = reported_.at_m[kWristOfHand];
  shifted_m_ = wrist_m_ + vector_at(errors, error::kShift);
  bent_m_ = joints_.at_m;
  for (std::size_t j = 0; j < joints_.at_m.size(); ++j) {
    joints_.at_m[j] = shifted_m_ + whole_ * (bent_m_[j] - wrist_m_);
    joints_.axes[j] = turn * joints_.axes[j];
  }
  for (int landmark = 0; landmark < kLandmarks; ++landmark) {
    const auto drift = error::drift_of(landmark);
    joints_.at_m[joint_of_landmark(landmark)] += glm::dvec3(errors[drift], errors[drift + 1], 0);
  }
}

}  // namespace handcast::renderer
