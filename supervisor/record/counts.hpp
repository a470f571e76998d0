// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/frame_delay.hpp"
#include "ipc/msg/light_source.hpp"

namespace handcast::supervisor {

/// A histogram of durations with logarithmic buckets, 16 per octave: percentiles are accurate to
/// 4.5 %.
class Histogram {
 public:
  /// Adds one duration; values below 1 ns count as 1 ns.
  void add(std::int64_t span_ns);
  /// Adds all durations of another histogram.
  void add(const Histogram& other);
  /// Removes all durations.
  void clear() { *this = Histogram(); }

  /// Number of durations.
  std::uint64_t count() const { return count_; }
  /// The duration that the fraction `share` (0..1) of all durations did not exceed; 0 if there are
  /// none.
  double percentile_ns(double share) const;

 private:
  static constexpr int kPerOctave = 16;
  static constexpr int kOctaves = 38;  ///< 1 ns to 275 s

  std::uint64_t count_ = 0;
  std::array<std::uint64_t, kPerOctave * kOctaves> buckets_{};  ///< 946 Hz fill 32 bits in 52 days
};

/// The images of the camera that were lost in a run, by reason. See msg::FrameLosses.
struct LossCount {
  std::uint64_t missing = 0, incomplete = 0, underrun = 0, skipped = 0;

  /// Adds what was lost before an image.
  void add(const msg::FrameLosses& lost) {
    missing += lost.missing;
    incomplete += lost.incomplete;
    underrun += lost.underrun;
    skipped += lost.skipped;
  }
  /// The counts with their names in reports.
  std::array<std::pair<std::string_view, std::uint64_t>, 4> by_reason() const {
    return {{{"missing", missing},
             {"incomplete", incomplete},
             {"underrun", underrun},
             {"skipped", skipped}}};
  }
};

/// What the output made of the frames of a projector.
struct LightCount {
  msg::LightSource source{};  ///< who says when light comes
  std::uint64_t missed = 0;   ///< refreshes of the output without a new frame
  std::uint64_t doubled = 0;  ///< frames that were shown for more than one refresh

  /// Adds the light of a frame.
  void add(const msg::LightNote& note) {
    source = note.source;
    if (note.refreshes < 2) return;
    missed += note.refreshes - 1;
    ++doubled;
  }
};

/// The slowest frames of a projector in a run, and what made them slow.
class SlowFrames {
 public:
  static constexpr std::size_t kKept = 100;  ///< number of frames that are kept

  /// Adds a frame that took `span_ns`.
  void add(std::int64_t span_ns, const msg::FrameDelay& delay);

  /// Frames by what made them slow, the first of these that applies.
  struct Causes {
    std::size_t preempted = 0;  ///< another thread had the processor for 10 % of the frame or more
    std::size_t interrupted = 0;  ///< something else had: interrupts, a hypervisor
    std::size_t faulted = 0;      ///< there were page faults
    std::size_t own = 0;  ///< none: the work itself took longer, by memory or the processor's clock
  };
  Causes causes() const;
  /// Number of frames, at most kKept.
  std::size_t count() const { return slowest_.size(); }
  /// The time of the fastest of them, ns; 0 if there is none.
  std::int64_t least_ns() const { return slowest_.empty() ? 0 : slowest_.front().span_ns; }

 private:
  struct Frame {
    std::int64_t span_ns;
    msg::FrameDelay delay;
  };
  std::vector<Frame> slowest_;  ///< a heap; the fastest of them is its first
};

}  // namespace handcast::supervisor
