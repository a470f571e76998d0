// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace handcast::pose::openxr {

/// When a runtime is asked: once in a period, and more often while its answer is still the old one,
/// so that a new one is seen soon after it is there. All polls lie on a grid, so that a process
/// that wakes late does not ask for another time. Times are CLOCK_MONOTONIC. One thread.
class Polls {
 public:
  /// The period after which a runtime that repeats itself is asked again.
  static constexpr std::int64_t kListen_ns = 200'000;

  /// The first poll is a period after `start_ns`.
  Polls(double rate_hz, std::int64_t start_ns);

  /// The time of the next poll; one that was missed by more than half a period is skipped.
  std::int64_t next_ns(std::int64_t now_ns);
  /// The poll at next_ns() was made. `is_new`: its answer was a sample.
  void made(bool is_new);
  /// True if the last poll was no sample: what is new now was measured since then.
  bool is_listening() const { return repeated_ns_ > 0; }
  /// The number of periods from the first poll to that at `poll_ns`, which increases from new
  /// answer to new answer.
  std::uint64_t number(std::int64_t poll_ns) const;

 private:
  std::int64_t period_ns_, start_ns_, due_ns_;
  std::int64_t repeated_ns_ = 0;  ///< how long the answer has been the old one
};

}  // namespace handcast::pose::openxr
