// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/clock.hpp"

#include <cerrno>
#include <ctime>

namespace handcast {

std::int64_t now_ns() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
}

void sleep_until_ns(std::int64_t wake_ns) {
  if (wake_ns <= now_ns())
    return;  // clock_nanosleep adds the timer slack, about 50 us, even to a time in the past
  const timespec wake{wake_ns / 1'000'000'000, wake_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
  }
}

}  // namespace handcast
