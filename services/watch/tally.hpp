// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <ctime>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "services/watch/day.hpp"
#include "services/watch/rig_status.hpp"

namespace handcast::watch {

/// Counts what a rig does into its day. One thread.
class Tally {
 public:
  /// The day of the rig that was started at this time (CLOCK_MONOTONIC). A rig that was started
  /// after the day was written counts as another start, whose light is told anew; else what passed
  /// meanwhile was up-time.
  Tally(Day& day, std::int64_t rig_started_ns, std::int64_t now_ns, std::time_t time);

  /// Whether the rig was started after the day was written.
  bool rig_is_new() const { return rig_is_new_; }

  /// A frame of the projector.
  void add(const msg::StageMarks& marks);
  /// A sample of the tracker.
  void add(const msg::HandPoses& poses);
  /// What the supervisor says: restarts since the last time, and the drift.
  void add(const RigStatus& status, std::time_t time);
  /// How the rig is.
  struct State {
    bool is_dark = false;  ///< on purpose
    bool has_fault = false;
  };
  /// The time up to now has passed in this state.
  void pass(std::int64_t now_ns, std::time_t time, const State& state);

 private:
  Day& day_;
  bool rig_is_new_;
  std::int64_t passed_ns_;     ///< up to when pass() has counted
  std::int64_t hands_ns_ = 0;  ///< of the newest sample with hands; 0: there was none
  double visit_s_ = 0;         ///< how long they are there
};

}  // namespace handcast::watch
