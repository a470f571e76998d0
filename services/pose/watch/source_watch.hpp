// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/tracker_faults.hpp"
#include "renderer/predict/hand_sides.hpp"
#include "services/pose/watch/hand_watch.hpp"

namespace handcast::pose {

/// Judges the samples of a source. One thread.
class SourceWatch {
 public:
  /// The confidence of a hand that is repeated although it moves, and of one that may rest: at most
  /// these. The renderer ignores the first.
  static constexpr float kFrozen = 0, kAtRest = 0.5f;

  /// Judges a sample that arrived at `arrival_ns`. Removes hands that no person has, and lowers the
  /// confidence of frozen ones. A sample from the future becomes one without hands at its arrival:
  /// whoever kept it would refuse the true ones as older until that time. Returns what begins with
  /// this sample.
  msg::TrackerFaults look(msg::HandPoses& poses, std::int64_t arrival_ns);

  /// True if the newest sample has a hand, and none that repeats a pose.
  bool is_usable() const { return is_usable_; }

 private:
  void judge_age(std::int64_t age_ns, msg::TrackerFaults& faults);
  /// The sample with the sides that the hands had before.
  msg::HandPoses named(const msg::HandPoses& poses, msg::TrackerFaults& faults);

  std::array<HandWatch, 2> hands_;  ///< by side
  renderer::HandSides sides_;
  bool is_exchanged_ = false;
  bool is_usable_ = false;
  double usual_age_ns_ = 0;
  int ages_ = 0;  ///< that were seen, up to kKnown
};

}  // namespace handcast::pose
