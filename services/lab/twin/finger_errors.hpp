// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "config/sections/twin/tracker.hpp"
#include "services/lab/twin/finger_pose.hpp"
#include "services/lab/twin/random.hpp"

namespace handcast::twin {

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
