// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/estimate/hand_errors.hpp"

namespace handcast::renderer {

/// The joints of a hand in camera space, m; the columns of `axes` are those of msg::Joint.
struct HandJoints {
  std::array<glm::dvec3, msg::kJoints> at_m;
  std::array<glm::dmat3, msg::kJoints> axes;
};

/// A pose in tracker space as joints in camera space.
HandJoints in_camera(const calib::Calibration& calibration, const msg::HandPose& pose);
/// The same pose with its joints moved: the inverse of in_camera().
msg::HandPose in_tracker(const calib::Calibration& calibration, const HandJoints& joints,
                         msg::HandPose pose);

/// By how much the joints of each finger are bent, from knuckle to tip, rad; less than 0 if they
/// are bent backwards. Of the thumb, the lowest is 0.
using Flexions = std::array<std::array<double, kBendsOfFinger>, kFingers>;
Flexions flexions_of(const HandJoints& joints);

/// A tracker's hand without its errors, and how its landmarks move with them.
class ArticulatedHand {
 public:
  /// Takes the errors from a tracker's hand: displaces its joints, spreads and bends its fingers,
  /// then turns, scales and shifts it about its wrist, and displaces joints by their drift.
  ArticulatedHand(const HandJoints& reported, const HandErrors& errors);

  /// The joints without errors.
  const HandJoints& joints() const { return joints_; }
  /// By how much its fingers are bent, as reported.
  const Flexions& flexions() const { return flexions_; }
  /// The place of a joint without the errors of fingers and single joints, m.
  glm::dvec3 rigid_m(std::size_t joint) const {
    return shifted_m_ + whole_ * (reported_.at_m[joint] - wrist_m_);
  }

  /// Calls `add_vector(first, derivative)` for each vector of the errors on which the place of a
  /// landmark depends, and `add_number(index, derivative)` for each number: m per unit, camera
  /// space. Those of errors that last are taken at the reported posture. At the estimated one they
  /// would share the noise of what they are compared with, so a filter would believe to learn from
  /// it, and its hand would grow without end (Huang, Mourikis, Roumeliotis 2010).
  template <class AddVector, class AddNumber>
  void derivatives(int landmark, const AddVector& add_vector, const AddNumber& add_number) const;

 private:
  void bend(int finger, const HandErrors& errors);
  void place(const HandErrors& errors);

  HandJoints reported_, joints_;
  Flexions flexions_;
  /// Before the hand is turned: the joints, and the axes about which each finger bends and, last,
  /// spreads.
  /// @{
  std::array<glm::dvec3, msg::kJoints> bent_m_;
  std::array<std::array<glm::dvec3, kLandmarksOfFinger>, kFingers> axis_;
  /// @}
  glm::dmat3 whole_;      ///< turn and scale
  glm::dvec3 wrist_m_;    ///< as reported
  glm::dvec3 shifted_m_;  ///< the wrist after the shift
};

/// The joint of a landmark.
constexpr std::size_t joint_of_landmark(int landmark) {
  return static_cast<std::size_t>(msg::kJointOfLandmark[landmark]);
}

/// The axis about which a joint bends: to the left of the finger.
inline glm::dvec3 bend_axis(const HandJoints& joints, std::size_t joint) {
  return -joints.axes[joint][0];
}

/// The cross product as a matrix: cross_matrix(a) * b = a x b.
inline glm::dmat3 cross_matrix(const glm::dvec3& a) {
  return {glm::dvec3(0, a.z, -a.y), glm::dvec3(-a.z, 0, a.x), glm::dvec3(a.y, -a.x, 0)};
}

template <class AddVector, class AddNumber>
void ArticulatedHand::derivatives(int landmark, const AddVector& add_vector,
                                  const AddNumber& add_number) const {
  const auto joint = joint_of_landmark(landmark);
  const int finger = finger_of_landmark(landmark);
  const glm::dvec3 from_wrist = whole_ * (reported_.at_m[joint] - wrist_m_);
  add_vector(error::kShift, glm::dmat3(1));
  add_vector(error::kTurn, -cross_matrix(from_wrist));
  add_number(error::kSize, from_wrist);
  add_number(error::drift_of(landmark), glm::dvec3(1, 0, 0));
  add_number(error::drift_of(landmark) + 1, glm::dvec3(0, 1, 0));
  add_vector(error::place_of(landmark), whole_ * reported_.axes[joint]);
  if (finger < 0) return;
  const auto knuckle = joint_of_landmark(first_landmark(finger));
  for (std::size_t centre = knuckle; centre < std::min(joint, knuckle + kBendsOfFinger); ++centre) {
    const auto b = static_cast<int>(centre - knuckle);
    add_number(error::bend_of(finger, b),
               whole_ * glm::cross(axis_[finger][b], bent_m_[joint] - bent_m_[centre]));
    add_number(error::missing_of(finger),
               whole_ * glm::cross(flexions_[finger][b] * bend_axis(reported_, centre),
                                   reported_.at_m[joint] - reported_.at_m[centre]));
  }
  add_number(error::spread_of(finger),
             whole_ * glm::cross(axis_[finger][kBendsOfFinger], bent_m_[joint] - bent_m_[knuckle]));
}

}  // namespace handcast::renderer
