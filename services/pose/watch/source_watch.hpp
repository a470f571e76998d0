// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/tracker_faults.hpp"
#include "renderer/predict/continuity.hpp"
#include "renderer/predict/hand_sides.hpp"

namespace handcast::pose {

/// Judges the samples of one hand of a source. One thread.
class HandWatch {
 public:
  /// How much a repeated pose says about the hand.
  enum class Frozen {
    no,       ///< it was measured, as far as can be told
    at_rest,  ///< it has been repeated for a second, but the hand may rest
    moving    ///< it was repeated while the hand moved
  };

  /// Adds a sample of `origin_ns`, and the faults that begin with it.
  void add(std::int64_t origin_ns, const msg::HandPose& pose, msg::TrackerFaults& faults);
  /// The source has delivered a sample without this hand.
  void miss(std::int64_t origin_ns);

  /// The hand in the newest sample that had it; empty if it is older than 0.2 s.
  std::optional<msg::HandPose> recent(std::int64_t time_ns) const;
  /// Whether the newest sample repeats a pose.
  Frozen frozen() const { return frozen_; }

 private:
  using Sample = renderer::Continuity::Sample;

  void judge_repeat(std::int64_t origin_ns, const msg::HandPose& pose, msg::TrackerFaults& faults);
  void judge_motion(const Sample& sample, msg::TrackerFaults& faults);

  renderer::Continuity continuity_;
  std::optional<Sample> last_;    ///< the newest sample that was measured
  std::optional<Sample> before_;  ///< at least 6 ms earlier
  std::int64_t seen_ns_ = 0;      ///< the newest sample that had the hand
  bool is_missed_ = false;        ///< the newest sample did not have the hand
  Frozen frozen_ = Frozen::no;
};

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
