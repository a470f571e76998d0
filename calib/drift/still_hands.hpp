// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "calib/drift/held_hand.hpp"

namespace handcast::calib {

/// Waits for one hand to be held still at a place where it was not before. One thread.
class StillHands {
 public:
  /// Adds a sample of the tracker. Times ascend; others are ignored. Numbers that are not finite
  /// end the moment.
  void add(std::int64_t time_ns, const TrackedHand& hand);
  /// Adds the landmarks of an image that was taken at a time. Returns the hand if it has been still
  /// for half a second, by the tracker and in the images, and was somewhere else, or otherwise
  /// turned, when it was returned the last time.
  std::optional<HeldHand> add(std::int64_t time_ns, const SeenHand& seen);
  /// True if the tracker has not seen the hand for a second before `time_ns`: the next one may be
  /// another person's.
  bool is_gone(std::int64_t time_ns) const;

 private:
  /// An image with the tracker's hand at the same time.
  struct Pair {
    std::int64_t time_ns;
    TrackedHand tracked;
    SeenHand seen;
  };
  std::optional<TrackedHand> tracked_at(std::int64_t time_ns) const;
  bool is_new(const TrackedHand& hand) const;
  std::optional<HeldHand> held() const;

  struct Sample {
    std::int64_t time_ns;
    TrackedHand hand;
  };
  std::deque<Sample> samples_;
  std::deque<Pair> pairs_;
  std::optional<TrackedHand> last_;  ///< that was returned
};

}  // namespace handcast::calib
