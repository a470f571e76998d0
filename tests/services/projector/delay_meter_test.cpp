// SPDX-License-Identifier: Apache-2.0
#include "services/projector/delay_meter.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstring>

namespace handcast::projector {
namespace {

TEST(DelayMeter, TimeOffTheProcessorIsMeasured) {
  const DelayMeter meter;
  sleep_until_ns(now_ns() + 20'000'000);
  EXPECT_GE(meter.delay().off_cpu_us, 15'000u);  // waking up takes time on the processor, too
}

TEST(DelayMeter, PageFaultsAreCounted) {
  constexpr std::size_t kPages = 16, kBytes = kPages * 4096;
  void* memory = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  const DelayMeter meter;
  std::memset(memory, 1, kBytes);
  EXPECT_GE(meter.delay().faults, 1u);
  munmap(memory, kBytes);
}

}  // namespace
}  // namespace handcast::projector
