// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace handcast::bridge {

/// A question to another computer and its answer, by the clocks of both.
struct ClockExchange {
  /// When the question was sent and the answer came, by our clock.
  /// @{
  std::int64_t asked_ns = 0, heard_ns = 0;
  /// @}
  /// When the question came and the answer was sent, by their clock.
  /// @{
  std::int64_t arrived_ns = 0, answered_ns = 0;
  /// @}
};

/// What is known of another computer's clock at one time.
struct ClockReading {
  std::int64_t offset_ns = 0;  ///< their clock minus ours
  std::int64_t error_ns = 0;   ///< half the width of the interval in which the offset lies
  double drift_ppm = 0;        ///< how much faster their clock runs
};

/// The CLOCK_MONOTONIC of another computer as a line over ours. A message takes some time, of which
/// only is known that it is not negative: a question bounds the line from above (arrived - asked),
/// an answer from below (answered - heard). All lines between the bounds of the last seconds form a
/// convex polygon in the plane of offset and drift (Zhang, Liu, Xia, "Clock Synchronization
/// Algorithms for Network Measurements", INFOCOM 2002). Its width is the error, or half the time on
/// the way of the fastest exchange if that is more: a rate that changes makes the polygon too
/// small. Delays may differ between the directions. The fastest messages bound most. One thread.
class ClockMap {
 public:
  /// No clock shows more: 70 years after the start of a computer.
  static constexpr std::int64_t kLatest_ns = std::int64_t{1} << 61;

  /// What an exchange has told.
  enum class News {
    none,        ///< it fits to those before
    jumped,      ///< it does not fit: a clock was set or stood still. Only this exchange counts now
    impossible,  ///< it was answered before it came, or took longer there than here: left out
  };
  News add(const ClockExchange& exchange);

  /// The offset at a time of our clock; empty before the first exchange.
  std::optional<ClockReading> at(std::int64_t our_ns) const;
  /// A time of their clock on ours; empty before the first exchange, or if it is no time.
  std::optional<std::int64_t> to_ours(std::int64_t their_ns) const;

 private:
  /// Offset (ns, relative to reference_ns_) at newest_ns_, and drift (ns per ns).
  struct Line {
    double offset = 0, drift = 0;
  };
  bool bound(const ClockExchange& exchange);

  std::deque<ClockExchange> exchanges_;  ///< the oldest first; all of them fit together
  std::vector<Line> corners_;            ///< of the polygon, in order
  std::int64_t newest_ns_ = 0, reference_ns_ = 0;
  std::int64_t least_error_ns_ = 0;
};

}  // namespace handcast::bridge
