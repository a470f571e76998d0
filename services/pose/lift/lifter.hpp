// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/pose/lift/hand_lifter.hpp"

namespace handcast::pose {

/// Lifts the landmarks of both hands. The pose service and the simulator call it. One thread.
class Lifter {
 public:
  /// Loads the hand models of the rig. Errors: those of load_hand_or_default().
  static Result<Lifter> open(const config::Rig& rig, const calib::Calibration& calibration);

  /// The hands of a detection, in tracker space, with its frame id and origin. Hands that cannot be
  /// lifted are left out.
  msg::HandPoses lift(const msg::Landmarks& landmarks);

 private:
  explicit Lifter(const std::array<HandLifter, msg::kMaxHands>& hands) : hands_(hands) {}

  std::array<HandLifter, msg::kMaxHands> hands_;  ///< by msg::Side
};

}  // namespace handcast::pose
