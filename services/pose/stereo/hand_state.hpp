// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "services/pose/lift/skeleton.hpp"

namespace handcast::pose::stereo {

/// A hand in the space of the first camera: its posture and the lengths of its bones.
struct HandState {
  Posture posture;     ///< with its size; see depth_m
  double depth_m = 0;  ///< z of the palm joint
  /// Logarithms of the bones' lengths relative to the model's at the hand's size.
  std::array<std::array<double, kAngles>, kFingers> log_bone{};
};

/// The unknowns of a hand, in this order: rotation of the palm about the camera's axes (3), its
/// place (3), the angles finger by finger (kMoving unknowns so far, which change with time), then
/// the logarithms of the size and of the bones' lengths, finger by finger (which do not).
inline constexpr int kPlaceAt = 3, kAnglesAt = 6, kMoving = kAnglesAt + kFingers * kAngles,
                     kSizeAt = kMoving, kBonesAt = kSizeAt + 1,
                     kUnknowns = kBonesAt + kFingers * kAngles;
using Unknowns = std::array<double, kUnknowns>;

/// `state`, changed by `step`.
HandState moved(HandState state, const Unknowns& step);
/// The step from one state to another. Rotations must differ by less than half a turn.
Unknowns difference(const HandState& from, const HandState& to);
/// The joints of the hand, in the space of the first camera.
PosedHand posed(const Skeleton& skeleton, const HandState& state);

}  // namespace handcast::pose::stereo
