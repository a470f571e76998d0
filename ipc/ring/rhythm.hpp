// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

namespace handcast::ipc {

/// Predicts when the next message of a regular stream will be published, from the times of the past
/// messages. One thread.
class Rhythm {
 public:
  /// The time in which a reader polls for the next message, CLOCK_MONOTONIC.
  struct Window {
    std::int64_t from_ns = 0;   ///< when to stop sleeping and start polling
    std::int64_t until_ns = 0;  ///< when to stop polling
  };

  /// Records a received message: its sequence and the time when it was published (CLOCK_MONOTONIC).
  /// Implausible times restart the averages.
  void received(std::uint64_t sequence, std::int64_t published_ns);
  /// When to poll for the next message; empty if the stream is new, or too fast, too slow or too
  /// irregular for polling to pay off.
  std::optional<Window> window() const;

 private:
  std::uint64_t last_sequence_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t period_ns_ = 0;
  std::int64_t jitter_ns_ = 0;  ///< mean absolute deviation from the period
  int periods_ = 0;             ///< number of consecutive periods in the averages
};

}  // namespace handcast::ipc
