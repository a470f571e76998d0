// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "services/lab/twin/finger_pose.hpp"

namespace handcast::twin {

/// How far the hand hides each of its fingers from an eye at the origin of `frames`' space, where a
/// tracker's cameras are: 0 seen, 1 hidden. The hand is a set of capsules around its bones; five
/// points from the PIP to the tip are looked for. A finger is also hidden if it is folded strongly,
/// since it is then seen from its knuckles only. Continuous in the pose.
std::array<double, kFingers> hidden_fingers(const JointFrames& frames,
                                            const std::array<float, kJoints>& radius_m);

/// How far the hand hides a place on a finger (or, with finger -1, on the palm) from an eye at the
/// origin: 0 seen, 1 hidden. `radius_m`: of the flesh around the place.
double hidden_place(const JointFrames& frames, const std::array<float, kJoints>& radii_m,
                    int finger, const glm::dvec3& place, double radius_m);

}  // namespace handcast::twin
