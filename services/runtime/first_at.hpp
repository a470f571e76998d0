// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace handcast::timing {

/// The first k >= `from` with time_of(k) >= time_ns, if `time_of` does not decrease. If it
/// decreases at some places (as arrival times do if messages overtake each other), the result is
/// `from` or a k with time_of(k - 1) < time_ns <= time_of(k), which need not be the first. Calls
/// `time_of` O(log k) times, so a daemon that is restarted after hours finds its place quickly.
template <class TimeOf>
std::uint64_t first_at(std::uint64_t from, std::int64_t time_ns, const TimeOf& time_of) {
  if (time_of(from) >= time_ns) return from;
  std::uint64_t before = from;
  std::uint64_t stride = 1;
  for (; time_of(before + stride) < time_ns; stride *= 2) before += stride;
  std::uint64_t reached = before + stride;
  while (reached - before > 1) {
    const std::uint64_t middle = before + (reached - before) / 2;
    if (time_of(middle) < time_ns)
      before = middle;
    else
      reached = middle;
  }
  return reached;
}

}  // namespace handcast::timing
