// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/prefault.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cstddef>
#include <cstring>

namespace handcast {
namespace {

constexpr std::size_t kBytes = std::size_t{8} << 20;

long faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

TEST(Prefault, TheFirstUseOfMemoryRaisesNoPageFault) {
  void* memory = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  if (prefault_memory() < kBytes) {
    munmap(memory, kBytes);
    GTEST_SKIP() << "the kernel or a sanitizer does not let it";
  }
  const long before = faults();
  std::memset(memory, 1, kBytes);
  EXPECT_EQ(faults() - before, 0);
  munmap(memory, kBytes);
}

}  // namespace
}  // namespace handcast
