// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/prefault.hpp"

#include <sys/mman.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace handcast {

#ifdef HANDCAST_WITH_SANITIZER

std::size_t prefault_memory() { return 0; }

#else

namespace {

// Of linux/mman.h, which older headers lack.
constexpr int kPopulateRead = 22, kPopulateWrite = 23;
constexpr std::size_t kLargest = std::size_t{256} << 20;
constexpr std::size_t kStack = std::size_t{256} << 10, kPage = 4096;

struct Mapping {
  std::uintptr_t begin, end;
  int advice;
};

/// The readable mappings of this process. Private memory that can be written is mapped for writing,
/// or its first write would copy a page.
std::vector<Mapping> mappings() {
  std::vector<Mapping> all;
  std::FILE* file = std::fopen("/proc/self/maps", "re");
  if (file == nullptr) return all;
  for (std::array<char, 4352> line{};
       std::fgets(line.data(), static_cast<int>(line.size()), file) != nullptr;) {
    unsigned long begin = 0, end = 0;
    std::array<char, 5> rights{};
    if (std::sscanf(line.data(), "%lx-%lx %4s", &begin, &end, rights.data()) != 3) continue;
    if (rights[0] != 'r' || end - begin > kLargest) continue;
    const bool is_written = rights[1] == 'w' && rights[3] == 'p';
    all.push_back({begin, end, is_written ? kPopulateWrite : kPopulateRead});
  }
  std::fclose(file);
  return all;
}

__attribute__((noinline)) void touch_stack() {
  std::array<char, kStack> below;
  for (std::size_t at = 0; at < below.size(); at += kPage)
    static_cast<volatile char*>(below.data())[at] = 0;
}

}  // namespace

std::size_t prefault_memory() {
  touch_stack();
  std::size_t bytes = 0;
  for (const auto& [begin, end, advice] : mappings())
    // NOLINTNEXTLINE(performance-no-int-to-ptr): /proc has numbers
    if (madvise(reinterpret_cast<void*>(begin), end - begin, advice) == 0) bytes += end - begin;
  return bytes;
}

#endif

}  // namespace handcast
