// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "tests/bench/stereo_rigs.hpp"

namespace handcast::bench {

/// Errors of joints against the truth, mm.
struct JointErrors {
  std::vector<double> all_mm;          ///< of the 21 joints that have landmarks
  std::vector<double> open_mm;         ///< of these, on hands without a folded finger
  std::vector<double> folded_tips_mm;  ///< of the tips of folded fingers
  /// Of where the cascade predicts the joints to be 16 ms after a sample.
  std::vector<double> later_mm;
  int hands = 0, missing = 0;       ///< true hands at the times of samples; not reported ones
  int poses = 0, exchanged = 0;     ///< reported hands; those that are where the other hand is
  std::vector<double> exchanges_s;  ///< how long each exchange lasted

  /// Adds the errors of another run.
  void add(const JointErrors& more);
};

/// A run of the tracker over a motion.
struct StereoTrial {
  JointErrors stereo;                ///< of our poses
  JointErrors tracker;               ///< of the twin's model of a tracker
  std::vector<double> work_us;       ///< thread time of StereoTracker::sample() per sample
  std::vector<double> landmarks_mm;  ///< of the landmarks in their views, across the line of sight
};

/// How a trial is run.
struct TrialPlan {
  double seconds = 4;
  bool hints = true;  ///< the network gets what the poses predict
  double anew_s = 0;  ///< detectors and tracker forget all after so long; 0: never
};

/// Draws the twin's images for both views, finds landmarks in them with the network, and makes
/// poses. Errors: those of the parts.
Result<StereoTrial> run_trial(const StereoRig& stereo, config::Rig rig, const TrialPlan& plan);

}  // namespace handcast::bench
