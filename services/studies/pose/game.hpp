// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "services/studies/pose/pose.hpp"

namespace handcast::study {

/// A pose that was matched.
struct MatchedPose {
  std::string name;
  double seconds = 0;  ///< from when it was shown, without the time in which no hand was seen
};

/// Guess the Pose: all poses are to be matched, in random order, one at a time. One is matched when
/// each finger has a score of kDone for kHeld_s. Pure: time and hand are given.
class PoseGame {
 public:
  PoseGame(std::vector<HeldPose> poses, std::uint64_t seed);

  /// Goes on by a time, at most 0.1 s. `held`: null if the hand is not seen.
  void step(double step_s, const HeldPose* held);
  /// The pose that is shown; null at the end.
  const HeldPose* wanted() const;
  /// Of the hand in the last step; empty without one.
  const std::optional<PoseScore>& score() const { return score_; }
  const std::vector<MatchedPose>& matched() const { return matched_; }

  static constexpr float kDone = 0.8f;
  static constexpr double kHeld_s = 0.5;

 private:
  std::vector<HeldPose> poses_;
  std::optional<PoseScore> score_;
  std::vector<MatchedPose> matched_;
  double shown_s_ = 0, held_s_ = 0;
};

/// How far each joint was bent and stretched: the range without the outermost 2 % on either side.
class RangeOfMotion {
 public:
  void see(const HeldPose& held);
  struct Range {
    float least_deg = 0, most_deg = 0;
  };
  /// Empty before the first hand.
  std::optional<std::array<Range, kFlexions>> ranges() const;

 private:
  std::array<std::array<std::uint32_t, 181>, kFlexions> seen_{};  ///< by joint and degree
  std::uint32_t count_ = 0;
};

}  // namespace handcast::study
