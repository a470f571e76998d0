// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

namespace handcast::ipc {

/// Learns when the next message of a regular stream will come, from the times its messages were
/// published.
class Rhythm {
 public:
  /// When to stop sleeping and watch for the message, and when to stop watching.
  struct Window {
    std::int64_t from_ns = 0;
    std::int64_t until_ns = 0;
  };

  void heard(std::uint64_t sequence, std::int64_t published_ns);
  /// Nothing while the stream is new, too slow or too irregular to be worth watching for.
  std::optional<Window> window() const;

 private:
  std::uint64_t last_sequence_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t period_ns_ = 0;
  std::int64_t jitter_ns_ = 0;  ///< mean distance from the period
  int heard_ = 0;               ///< periods in a row that went into the averages
};

}  // namespace handcast::ipc
