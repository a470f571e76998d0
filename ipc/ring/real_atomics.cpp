// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/real_atomics.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <climits>
#include <ctime>

namespace handcast::ipc {

void RealAtomics::wait(Word& word, std::uint64_t seen, std::int64_t until_ns) {
  if (until_ns <= 0) return;
  const timespec until{until_ns / 1'000'000'000, until_ns % 1'000'000'000};
  ::syscall(SYS_futex, &word.value, FUTEX_WAIT_BITSET, static_cast<std::uint32_t>(seen), &until,
            nullptr, FUTEX_BITSET_MATCH_ANY);
}

void RealAtomics::wake(Word& word) {
  ::syscall(SYS_futex, &word.value, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace handcast::ipc
