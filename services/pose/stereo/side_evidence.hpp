// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

namespace handcast::pose::stereo {

/// Whether a hand that is followed is the person's other hand: the logarithm of the odds, from what
/// has been seen since it began. One thread.
class SideEvidence {
 public:
  /// A comparison of the sides is due at this time.
  bool is_due(std::int64_t time_ns) const;
  /// Takes a comparison: the costs (HandFit::cost) of its landmarks as this hand and as the other
  /// one, and how many more detectors take it for the other one than for this one. Images in a
  /// short time have the same errors and count as one.
  void compare(std::int64_t time_ns, double cost, double cost_of_other, int votes_for_other);
  /// Takes the detectors' votes alone, of a hand that cannot be compared. A comparison is due
  /// still.
  void vote(std::int64_t time_ns, int votes_for_other);
  /// Nothing is known; the next comparison is due when it was.
  void forget();

  /// Above 0: it is rather the other hand.
  double log_odds() const { return log_odds_; }

 private:
  void add(double log_odds);

  double log_odds_ = 0;
  /// Times of the last comparison and of the last vote().
  std::optional<std::int64_t> compared_ns_, voted_ns_;
  bool is_known_ = false;  ///< log_odds_ has a comparison
};

}  // namespace handcast::pose::stereo
