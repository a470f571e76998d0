// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "calib/least_squares/levenberg_marquardt.hpp"
#include "calib/least_squares/normal_equations.hpp"
#include "services/pose/lift/skeleton.hpp"

/// What the fits of a hand to one view and to two share.
namespace handcast::pose {

/// A rotation after one by a rotation vector, rad.
inline glm::dquat turned_by(const glm::dquat& turn, const glm::dvec3& by) {
  const double angle = glm::length(by);
  return angle > 1e-12 ? glm::normalize(glm::angleAxis(angle, by / angle) * turn) : turn;
}

/// The rotation vector from one rotation to another, which must differ by less than half a turn.
inline glm::dvec3 turn_between(const glm::dquat& from, const glm::dquat& to) {
  glm::dquat turned = to * glm::conjugate(from);
  if (turned.w < 0) turned = -turned;
  const glm::dvec3 axis(turned.x, turned.y, turned.z);
  const double sine = glm::length(axis);
  return sine > 1e-12 ? axis * (2 * std::atan2(sine, turned.w) / sine) : axis;
}

/// The derivatives of the place of a landmark by those unknowns that move it.
struct Moves {
  static constexpr int kMost = 15;
  std::array<glm::dvec3, kMost> by;
  std::array<int, kMost> columns;  ///< in the order of add()
  int count = 0;

  void add(int column, const glm::dvec3& move) {
    columns[count] = column;
    by[count++] = move;
  }
  /// Rotation of the palm about the camera's axes: unknowns 0 to 2.
  void add_turn(const glm::dvec3& arm_m) {
    add(0, {0, -arm_m.z, arm_m.y});
    add(1, {arm_m.z, 0, -arm_m.x});
    add(2, {-arm_m.y, arm_m.x, 0});
  }
  /// The angles before a landmark of a finger, whose first one is unknown `column`.
  void add_angles(const PosedHand& hand, int landmark, int column) {
    const int finger = (landmark - 1) / 4, along = landmark > 0 ? (landmark - 1) % 4 : 0;
    const glm::dvec3 at_m = hand.place_m[msg::kJointOfLandmark[landmark]];
    for (int a = 0; a < kAngles && std::max(0, a - 1) < along; ++a) {
      const glm::dvec3 pivot_m = hand.place_m[kFirstJoint[finger] + std::max(0, a - 1)];
      add(column + a, glm::cross(hand.hinge[finger][a], at_m - pivot_m));
    }
  }
};

/// Fits `state` in at most `steps` steps and returns the equations of the result. `most(i)`: the
/// longest step of unknown i for which the linearisation is good.
template <class Unknowns, class State, class EquationsAt, class Most>
auto fit_hand(State& state, int steps, const EquationsAt& equations_at, const Most& most) {
  constexpr double kDone = 1e-3;
  return calib::minimise(state, {steps, kDone}, equations_at,
                         [&](const State& from, const auto& step) {
                           Unknowns by;
                           for (int i = 0; i < std::ssize(by); ++i)
                             by[i] = std::clamp(step[i], -most(i), most(i));
                           return moved(from, by);
                         });
}

/// The variances of the unknowns; 0 if the equations do not determine them.
template <class Unknowns>
Unknowns variances_of(const calib::NormalEquations& equations) {
  Unknowns variances{};
  if (const auto covariance = equations.covariance())
    for (int i = 0; i < std::ssize(variances); ++i) variances[i] = (*covariance)(i, i);
  return variances;
}

}  // namespace handcast::pose
