// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/msg/rung.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "supervisor/record/histogram.hpp"

namespace handcast::supervisor {

/// How many frames a service finished, and when.
class FrameCount {
 public:
  /// `missed` frames before this one were finished, but their marks were overwritten before they
  /// were read.
  void add(const msg::Header& frame, std::uint64_t missed);

  std::uint64_t total() const { return total_; }
  /// Frames a second over the last two seconds (or since the first frame, if that is less).
  double recent_hz(std::int64_t now_ns) const;
  /// Frames a second from one second after the first frame on, up to `now_ns`: with every
  /// interruption, without the start.
  double held_hz(std::int64_t now_ns) const;
  /// The age of the newest frame's origin; empty if there was none.
  std::optional<double> newest_age_ms(std::int64_t now_ns) const;

 private:
  std::uint64_t total_ = 0;
  std::uint64_t settled_ = 0;  ///< of these, later than the first second
  std::int64_t first_ns_ = 0;
  std::int64_t newest_origin_ns_ = 0;
  struct Arrival {
    std::int64_t time_ns;
    std::uint64_t frames;
  };
  std::deque<Arrival> recent_;
};

/// Times of one stage over the last ten seconds and over the whole run.
class StageTimes {
 public:
  void add(std::int64_t ended_ns, std::int64_t span_ns);

  const Histogram& whole_run() const { return whole_run_; }
  Histogram recent(std::int64_t now_ns) const;

 private:
  static constexpr int kWindow_s = 10;
  struct Second {
    std::int64_t number = -1;  ///< of CLOCK_MONOTONIC
    Histogram times;
  };
  Histogram whole_run_;
  std::array<Second, kWindow_s> seconds_;
};

/// What the recorder has seen: every service's frames, every stage's times.
class Ledger {
 public:
  /// A message without marks is a heart-beat, not a frame.
  void note(std::string_view service, const msg::StageMarks& marks, std::uint64_t missed = 0);

  const FrameCount& frames(std::string_view service) const;
  const std::map<std::string, StageTimes, std::less<>>& stages() const { return stages_; }
  /// Hands of drawn frames that were given each rung of the ladder.
  const std::array<std::uint64_t, msg::kRungs>& rungs() const { return rungs_; }

 private:
  std::map<std::string, FrameCount, std::less<>> frames_;
  std::map<std::string, StageTimes, std::less<>> stages_;
  std::array<std::uint64_t, msg::kRungs> rungs_{};
};

}  // namespace handcast::supervisor
