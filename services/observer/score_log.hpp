// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>

namespace handcast::observer {

/// The scores that are logged; docs/operating/figures.md explains them.
struct LoggedScores {
  double interior_p95_mm = 0;  ///< of the last one to two minutes, as the others
  double coverage = 0, spill = 0;
};

/// Says when scores are worth a line of the log: at first, a minute later, when they are those of a
/// rig that runs, every hour, and when they have changed so much that a person would see it. At
/// most one line a minute. One thread.
class ScoreLog {
 public:
  /// True if the scores of this moment should be logged.
  bool is_due(std::int64_t now_ns, const LoggedScores& scores) {
    const bool is_early = lines_ == 1 || differs(scores);
    if (lines_ > 0 && now_ns - told_ns_ < (is_early ? kMinute_ns : kHour_ns)) return false;
    ++lines_;
    told_ns_ = now_ns;
    told_ = scores;
    return true;
  }

 private:
  static constexpr std::int64_t kMinute_ns = 60'000'000'000, kHour_ns = 60 * kMinute_ns;

  bool differs(const LoggedScores& scores) const {
    constexpr double kShare = 0.5, kLeast_mm = 1, kRatio = 0.05;
    const auto by = [](double a, double b) { return std::abs(a - b); };
    return by(scores.interior_p95_mm, told_.interior_p95_mm) >
               kLeast_mm + kShare * told_.interior_p95_mm ||
           by(scores.coverage, told_.coverage) > kRatio || by(scores.spill, told_.spill) > kRatio;
  }

  std::int64_t lines_ = 0, told_ns_ = 0;
  LoggedScores told_;
};

}  // namespace handcast::observer
