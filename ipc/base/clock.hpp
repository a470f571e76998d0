// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstdint>

namespace handcast {

/// The current time in nanoseconds of CLOCK_MONOTONIC, the only clock of this project. All
/// processes of the machine share it, so time stamps of different processes can be compared. Time
/// stamps are int64 with the suffix `_ns`; durations are std::chrono. Any thread.
std::int64_t now_ns();

/// Sleeps until `wake_ns` (CLOCK_MONOTONIC); returns at once if that time has passed. Signals do
/// not end the sleep early.
void sleep_until_ns(std::int64_t wake_ns);

/// Conversions of durations between std::chrono, int64 nanoseconds, and double seconds, ms or us.
/// `seconds_to_ns` rounds to the nearest nanosecond.
/// @{
constexpr std::int64_t to_ns(std::chrono::nanoseconds span) { return span.count(); }
constexpr std::int64_t seconds_to_ns(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5));
}
constexpr std::int64_t ms_to_ns(double milliseconds) { return seconds_to_ns(milliseconds * 1e-3); }
constexpr double ns_to_seconds(std::int64_t span_ns) { return static_cast<double>(span_ns) * 1e-9; }
constexpr double ns_to_ms(std::int64_t span_ns) { return static_cast<double>(span_ns) * 1e-6; }
constexpr double ns_to_us(std::int64_t span_ns) { return static_cast<double>(span_ns) * 1e-3; }
/// @}

/// A point in time up to which a blocking call may wait.
class Deadline {
 public:
  /// The deadline `span` from now.
  static Deadline in(std::chrono::nanoseconds span) { return Deadline(now_ns() + span.count()); }
  /// The deadline at `time_ns` of CLOCK_MONOTONIC.
  static Deadline at_ns(std::int64_t time_ns) { return Deadline(time_ns); }
  /// A deadline in the past: the call polls once and does not wait.
  static Deadline now() { return Deadline(0); }

  /// The time of the deadline in nanoseconds of CLOCK_MONOTONIC.
  std::int64_t time_ns() const { return time_ns_; }
  /// True if the deadline is now or in the past.
  bool passed() const { return now_ns() >= time_ns_; }

 private:
  explicit Deadline(std::int64_t time_ns) : time_ns_(time_ns) {}
  std::int64_t time_ns_;
};

}  // namespace handcast
