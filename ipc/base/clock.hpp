// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstdint>

namespace handcast {

/// The one clock of the house: CLOCK_MONOTONIC in nanoseconds. It is the same for every process of
/// the machine, so a time stamp means the same on both sides of a ring. Time stamps are int64 `_ns`
/// everywhere, spans are std::chrono.
std::int64_t now_ns();

/// Sleeps until `wake_ns` (monotonic); returns at once if that is past. Signals do not cut the
/// sleep short.
void sleep_until_ns(std::int64_t wake_ns);

constexpr std::int64_t to_ns(std::chrono::nanoseconds span) { return span.count(); }
constexpr std::int64_t seconds_to_ns(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5));
}
constexpr std::int64_t ms_to_ns(double milliseconds) { return seconds_to_ns(milliseconds * 1e-3); }
constexpr double ns_to_seconds(std::int64_t span_ns) { return static_cast<double>(span_ns) * 1e-9; }
constexpr double ns_to_ms(std::int64_t span_ns) { return static_cast<double>(span_ns) * 1e-6; }
constexpr double ns_to_us(std::int64_t span_ns) { return static_cast<double>(span_ns) * 1e-3; }

/// A point in time up to which a blocking call may wait.
class Deadline {
 public:
  static Deadline in(std::chrono::nanoseconds span) { return Deadline(now_ns() + span.count()); }
  static Deadline at_ns(std::int64_t time_ns) { return Deadline(time_ns); }
  static Deadline now() { return Deadline(0); }  ///< poll once, do not wait

  std::int64_t time_ns() const { return time_ns_; }
  bool passed() const { return now_ns() >= time_ns_; }

 private:
  explicit Deadline(std::int64_t time_ns) : time_ns_(time_ns) {}
  std::int64_t time_ns_;
};

}  // namespace handcast
