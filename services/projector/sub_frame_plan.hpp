// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "config/sections/sub_frames.hpp"
#include "ipc/base/clock.hpp"
#include "services/projector/projector.hpp"
#include "services/projector/recent_times.hpp"

namespace handcast::projector {

/// The longest time that m drawings in a row took lately, for each m up to the number of sub-frames
/// of an output frame: slow drawings come in bursts, so that m times the slowest one would be too
/// much, and m times the usual one too little.
class LongestRuns {
 public:
  /// For up to `most` drawings in a row. Starts as if each had taken `first_ns`.
  LongestRuns(int most, std::int64_t first_ns)
      : last_ns_(static_cast<std::size_t>(most), first_ns), longest_ns_(last_ns_.size()) {
    for (auto& runs : recent_ns_) runs.assign(last_ns_.size(), 0);
    for (std::size_t i = 0; i < longest_ns_.size(); ++i)
      longest_ns_[i] = static_cast<std::int64_t>(i + 1) * first_ns;
  }

  /// The longest time of `drawings` (1 to `most`) in a row, in the 31 output frames before the last
  /// begin_output_frame().
  std::int64_t of(int drawings) const {
    return longest_ns_[static_cast<std::size_t>(drawings - 1)];
  }

  /// Adds the time of a drawing.
  void add(std::int64_t time_ns) {
    last_ns_[count_++ % last_ns_.size()] = time_ns;
    auto& runs = recent_ns_[output_frames_ % recent_ns_.size()];
    std::int64_t sum_ns = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      sum_ns += last_ns_[(count_ + last_ns_.size() - 1 - i) % last_ns_.size()];
      runs[i] = std::max(runs[i], sum_ns);
    }
  }
  /// Takes the drawings of the output frame before into account.
  void begin_output_frame() {
    if (count_ == 0) return;
    for (std::size_t i = 0; i < longest_ns_.size(); ++i) {
      longest_ns_[i] = 0;
      for (const auto& runs : recent_ns_) longest_ns_[i] = std::max(longest_ns_[i], runs[i]);
    }
    auto& oldest = recent_ns_[++output_frames_ % recent_ns_.size()];
    std::ranges::fill(oldest, 0);
  }

 private:
  std::vector<std::int64_t> last_ns_;  ///< the times of the last drawings, a ring
  /// The longest runs that ended in each of the last output frames; run i has i + 1 drawings.
  std::array<std::vector<std::int64_t>, 31> recent_ns_;
  std::vector<std::int64_t> longest_ns_;  ///< of all recent_ns_
  std::size_t count_ = 0, output_frames_ = 0;
};

/// Decides when each sub-frame of an output frame is drawn, and for which time. The output frame is
/// handed over when the projector takes it, complete: sub-frames are drawn just before, in the
/// order in which they are lit, as late as the slowest drawings of late allow (LongestRuns). If
/// there is not enough time for all of them, a drawing is lit in several sub-frames and is made for
/// the middle of their time; the later drawings are, because the time may yet suffice. One thread.
class SubFramePlan {
 public:
  /// The sub-frames [first, first + count) of an output frame, and their drawing.
  struct Drawing {
    int first = 0;               ///< the first of its sub-frames
    int count = 0;               ///< how many there are
    std::int64_t begin_ns = 0;   ///< when to begin it
    std::int64_t target_ns = 0;  ///< the middle of its light
  };

  /// Uses packing, rate_hz, latency_ms and software_ms.
  explicit SubFramePlan(const config::Projector& settings)
      : sub_frames_(config::sub_frames_of(settings.packing)),
        period_ns_(seconds_to_ns(1 / settings.rate_hz)),
        drawing_(std::max<std::int64_t>(ms_to_ns(settings.software_ms), 1)),
        drawings_(sub_frames_, drawing_.median_ns()),
        light_(ms_to_ns(settings.latency_ms) + output_period_ns() / 2) {}

  /// Begins an output frame, which is handed over as soon as possible: one drawing must be possible
  /// before.
  void start(std::int64_t now_ns) {
    if (hand_over_ns_ == 0) hand_over_ns_ = now_ns;
    if (next_sub_frame_ > 0) hand_over_ns_ += output_period_ns();
    const std::int64_t soonest_ns = now_ns + drawing_.median_ns() + reserve_ns(),
                       period_ns = std::max<std::int64_t>(output_period_ns(), 1);
    if (hand_over_ns_ < soonest_ns)
      hand_over_ns_ += (soonest_ns - hand_over_ns_ + period_ns - 1) / period_ns * period_ns;
    next_sub_frame_ = 0;
    drawings_.begin_output_frame();
  }
  /// The next drawing; empty if all sub-frames are drawn, or there is no time for another drawing.
  std::optional<Drawing> next(std::int64_t now_ns) const {
    const int left = left_to_draw();
    if (left == 0) return std::nullopt;
    const std::int64_t each_ns = drawing_.median_ns(), last_ns = hand_over_ns_ - reserve_ns();
    const std::int64_t fitting = (last_ns - now_ns) / each_ns;
    if (fitting < 1 && next_sub_frame_ > 0) return std::nullopt;
    const auto drawings =
        static_cast<int>(std::clamp<std::int64_t>(fitting, 1, static_cast<std::int64_t>(left)));
    Drawing drawing{next_sub_frame_, left / drawings, last_ns - drawings_.of(left)};
    drawing.target_ns = hand_over_ns_ + light_.median_ns() +
                        (2 * drawing.first + drawing.count - sub_frames_) * period_ns_ / 2;
    return drawing;
  }
  /// Notes that the drawing is done, and how long it took.
  void drawn(const Drawing& drawing, std::int64_t took_ns) {
    next_sub_frame_ = drawing.first + drawing.count;
    drawing_.add(std::max<std::int64_t>(took_ns, 1));
    drawings_.add(took_ns);
  }
  /// Number of sub-frames without a drawing.
  int left_to_draw() const { return sub_frames_ - next_sub_frame_; }

  /// When the output frame should be handed over.
  std::int64_t hand_over_ns() const { return hand_over_ns_; }
  /// Notes when it was.
  void presented(const PresentTimes& times) {
    light_.add(times.display_ns - hand_over_ns_);
    if (times.next_ns == 0) return;
    hand_over_ns_ = times.next_ns - output_period_ns();  // the projector has its own rhythm
  }

  /// The times of a sub-frame whose output frame has `times`. A projector takes only whole output
  /// frames: `handed_ns` is the time that is as long before its light as for the first sub-frame.
  PresentTimes times_of(int sub_frame, const PresentTimes& times) const {
    const std::uint32_t refreshes = sub_frame == 0 ? times.note.refreshes : 0;
    return {.handed_ns = times.handed_ns + sub_frame * period_ns_,
            .display_ns = times.display_ns + (2 * sub_frame + 1 - sub_frames_) * period_ns_ / 2,
            .note = {times.note.source, refreshes}};
  }
  /// Time from one output frame to the next.
  std::int64_t output_period_ns() const { return sub_frames_ * period_ns_; }

 private:
  /// For a last drawing that is slower than all of late, and for the projector.
  std::int64_t reserve_ns() const { return 300'000 + drawing_.median_ns() / 4; }

  int sub_frames_;
  std::int64_t period_ns_;
  RecentTimes drawing_;   ///< time of a drawing
  LongestRuns drawings_;  ///< time of several drawings
  RecentTimes light_;     ///< from handing over to the middle of the light
  std::int64_t hand_over_ns_ = 0;
  int next_sub_frame_ = 0;
};

}  // namespace handcast::projector
