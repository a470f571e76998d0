// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/msg/bridge_note.hpp"
#include "ipc/msg/detector_note.hpp"
#include "ipc/msg/drift_note.hpp"
#include "ipc/msg/rung.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/msg/tracker_faults.hpp"
#include "supervisor/record/counts.hpp"

namespace handcast::supervisor {

/// Counts the frames of one service.
class FrameCount {
 public:
  /// Adds a frame, and `missed` frames before it whose marks were overwritten before they were
  /// read.
  void add(const msg::Header& frame, std::uint64_t missed);

  /// True from a second after the first frame on.
  bool is_settled() const { return settled_ > 0; }
  /// Number of all frames.
  std::uint64_t total() const { return total_; }
  /// Frames per second over the last two seconds, or since the first frame if that is less.
  double recent_hz(std::int64_t now_ns) const;
  /// Frames per second up to `now_ns`, without the first second. Includes all interruptions.
  double held_hz(std::int64_t now_ns) const;
  /// The age of the newest frame's origin in ms; empty if there was no frame.
  std::optional<double> newest_age_ms(std::int64_t now_ns) const;

 private:
  std::uint64_t total_ = 0;
  std::uint64_t settled_ = 0;  ///< frames after the first second
  std::int64_t first_ns_ = 0;
  std::int64_t newest_origin_ns_ = 0;
  struct Arrival {
    std::int64_t time_ns;
    std::uint64_t frames;
  };
  std::deque<Arrival> recent_;
};

/// The times that one stage took, over the last ten seconds and over the whole run.
class StageTimes {
 public:
  /// Adds a duration that ended at `ended_ns`, CLOCK_MONOTONIC.
  void add(std::int64_t ended_ns, std::int64_t span_ns);

  /// The durations of the whole run.
  const Histogram& whole_run() const { return whole_run_; }
  /// The durations of the last ten seconds, in steps of a second.
  Histogram recent(std::int64_t now_ns) const;

 private:
  static constexpr int kWindow_s = 10;
  struct Second {
    std::int64_t number = -1;  ///< seconds of CLOCK_MONOTONIC
    Histogram times;
  };
  Histogram whole_run_;
  std::array<Second, kWindow_s> seconds_;
};

/// "draw", or "draw2" if the service is the second instance of a program.
std::string name_at_instance(std::string_view name, std::string_view service);

/// The statistics of a run: the frames of each service, the times of each stage, the rungs. One
/// thread.
class Ledger {
 public:
  /// Adds a frame. A message without marks is a heartbeat and does not count as a frame. `missed`:
  /// see FrameCount::add().
  void add(std::string_view service, const msg::StageMarks& marks, std::uint64_t missed = 0);

  /// The frames of a service; zeros if it is unknown.
  const FrameCount& frames(std::string_view service) const;
  /// The times of each stage, by its name_at_instance().
  const std::map<std::string, StageTimes, std::less<>>& stages() const { return stages_; }
  /// Number of drawn hands that got each rung of the ladder, by msg::Rung.
  const std::array<std::uint64_t, msg::kRungs>& rungs() const { return rungs_; }
  /// The slowest frames of each projector, by its service, without the first second.
  const std::map<std::string, SlowFrames, std::less<>>& slow_frames() const { return slow_frames_; }
  /// The light of each projector that has shown some, by its service.
  const std::map<std::string, LightCount, std::less<>>& lights() const { return lights_; }
  /// The images that the camera lost.
  const LossCount& lost_images() const { return lost_images_; }
  /// What the tracker did wrong: how often each kind of fault began.
  const std::array<std::uint64_t, msg::kTrackerFaults>& tracker_faults() const {
    return tracker_faults_;
  }
  /// Where the tracker seems to be, by its newest sample.
  const msg::DriftNote& tracker_drift() const { return tracker_drift_; }
  /// Of the newest message from another computer; empty: none has come.
  const std::optional<msg::BridgeNote>& bridge() const { return bridge_; }
  /// What a service that detects landmarks said of itself last.
  msg::DetectorNote detector(std::string_view service) const;

 private:
  std::map<std::string, FrameCount, std::less<>> frames_;
  std::map<std::string, StageTimes, std::less<>> stages_;
  std::array<std::uint64_t, msg::kRungs> rungs_{};
  std::map<std::string, SlowFrames, std::less<>> slow_frames_;
  std::map<std::string, LightCount, std::less<>> lights_;
  LossCount lost_images_;
  std::array<std::uint64_t, msg::kTrackerFaults> tracker_faults_{};
  msg::DriftNote tracker_drift_;
  std::optional<msg::BridgeNote> bridge_;
  std::map<std::string, msg::DetectorNote, std::less<>> detectors_;  ///< by service
};

}  // namespace handcast::supervisor
