// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdlib>
#include <ctime>

#include "ipc/base/clock.hpp"
#include "services/watch/day.hpp"

namespace handcast::watch::test {

/// Universal time, whatever the computer's is.
inline void use_utc() {
  ::setenv("TZ", "UTC", 1);
  ::tzset();
}

/// 2026-12-24 12:00:00 UTC.
inline constexpr std::time_t kNoon = 1'798'113'600;

/// A time of CLOCK_MONOTONIC.
inline std::int64_t at_s(double seconds) { return seconds_to_ns(seconds); }

/// A day with something in each of its members.
inline Day full_day() {
  Day day{.rig = "show", .date = "2026-12-24", .up_s = 36'000, .lit_s = 28'800, .dark_s = 7'200};
  day.starts = 2;
  day.restarts = {{"pose", {{"signal 9 (Killed)", 3}, {"exit 111", 1}}}};
  for (int i = 0; i < 99; ++i) day.latencies.add(12.34);
  day.latencies.add(80);
  day.frames = 1000;
  day.missed_refreshes = 7;
  day.visits = 12;
  day.hands_s = 3'725;
  day.longest_visit_s = 95;
  day.drift = Drift{true, 4.25, 0.5};
  day.disk_free_gb = 12.5;
  day.disk_gb = 100;
  day.faults = {{"service pose", "service pose dies <again>", "2026-12-24 10:00:00",
                 "2026-12-24 10:01:00", "2026-12-24_10-00-00", true},
                {"disk", "the disk is nearly full", "2026-12-23 09:00:00", "", "", true}};
  day.note(kNoon, "the rig was started");
  day.minutes.replace(600, 60, 60, 'l');
  day.rig_started_ns = 123;
  day.counted_until = kNoon;
  day.counted = {{"pose", 4}};
  day.lights = false;
  day.alerted = {{"disk", kNoon}};
  return day;
}

}  // namespace handcast::watch::test
