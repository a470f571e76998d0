// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <ctime>

#include "ipc/base/clock.hpp"
#include "ipc/msg/frame_delay.hpp"

namespace handcast::projector {

/// Measures what keeps the calling thread from its work. Each call takes about 1 us.
class DelayMeter {
 public:
  /// Starts now.
  DelayMeter() : start_(read()) {}
  /// What kept the thread from its work since the start.
  msg::FrameDelay delay() const {
    const Reading now = read();
    const std::int64_t off_ns = (now.time_ns - start_.time_ns) - (now.cpu_ns - start_.cpu_ns);
    return {static_cast<std::uint32_t>(std::max<std::int64_t>(off_ns, 0) / 1000),
            static_cast<std::uint32_t>(now.preemptions - start_.preemptions),
            static_cast<std::uint32_t>(now.faults - start_.faults)};
  }

 private:
  struct Reading {
    std::int64_t time_ns, cpu_ns;
    long preemptions, faults;
  };
  static Reading read() {
    timespec cpu{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &cpu);
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    return {now_ns(), cpu.tv_sec * std::int64_t{1'000'000'000} + cpu.tv_nsec, usage.ru_nivcsw,
            usage.ru_minflt + usage.ru_majflt};
  }

  Reading start_;
};

}  // namespace handcast::projector
