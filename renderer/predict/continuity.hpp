// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Distinguishes a tracker that jumps (after a freeze, a swap of hands, a wrong finger) from a hand
/// that moves. The limits adapt to the samples of one hand: a hand that has been shaken for a while
/// may accelerate more. One thread.
class Continuity {
 public:
  /// One sample of the tracker.
  struct Sample {
    std::int64_t origin_ns;  ///< when it was taken, CLOCK_MONOTONIC
    msg::HandPose pose;      ///< tracker space
  };

  /// Returns true if the tracker jumped between `last` and `next`: after a gap of more than 50 ms
  /// and more than five usual intervals, or if at least four joints are too far from where the
  /// motion from `before` to `last` leads. `before` is nullptr if there is no earlier sample.
  /// Learns the usual interval and acceleration.
  bool broken(const Sample* before, const Sample& last, const Sample& next);

  /// Returns true if `next` equals `last` bit by bit although the hand moved faster than 20 mm/s
  /// from `before` to `last`: the tracker repeats a pose that it did not measure.
  static bool frozen(const Sample* before, const Sample& last, const msg::HandPose& next);

  /// The tracker counts as silent after this long without a sample: 2.5 usual intervals, at least
  /// 25 ms.
  std::int64_t patience_ns() const;

 private:
  std::int64_t interval_ns_ = 9'000'000;  ///< mean interval between samples
  float usual_m_s2_ = 0;                  ///< mean deviation from constant velocity
};

}  // namespace handcast::renderer
