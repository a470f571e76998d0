// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "config/sections/twin/tracker.hpp"
#include "services/lab/twin/finger_pose.hpp"
#include "services/lab/twin/random.hpp"

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

/// What a tracker gets wrong about the flexion of fingers: a part of it is always missing, a finger
/// that the hand hides is guessed, and at times a finger snaps to a wrong flexion. Pure functions
/// of the settings, the seed and the arguments.
class FingerErrors {
 public:
  /// Copies its arguments. `radius_m`: of the flesh at the joints of the true hand.
  FingerErrors(const config::TwinTracker& settings, int seed,
               const std::array<float, kJoints>& radius_m);

  /// The hand as the tracker takes it to be. `truth`: in tracker space; its bones keep their
  /// lengths.
  JointFrames seen(renderer::Side side, double seconds, const JointFrames& truth) const;

 private:
  double guess_rad(renderer::Side side, int finger, double seconds) const;
  double snap_rad(renderer::Side side, int finger, double seconds) const;

  config::TwinTracker settings_;
  std::array<float, kJoints> radius_m_;
  Random guesses_, snaps_;
};

}  // namespace handcast::twin
