// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

/// What makes a frame late now and then, counted in the process of a test. frame_costs.cpp must be
/// among the sources of the test: it replaces malloc() and others of the C library.
namespace handcast::test {

/// Counts of the calling thread since it began.
struct FrameCosts {
  std::uint64_t allocations = 0;  ///< malloc() and its relatives, and so operator new
  std::uint64_t locks = 0;        ///< pthread_mutex_lock(), and so std::mutex
  std::uint64_t faults = 0;       ///< page faults, minor and major

  FrameCosts& operator+=(const FrameCosts& more) {
    allocations += more.allocations;
    locks += more.locks;
    faults += more.faults;
    return *this;
  }
  friend FrameCosts operator-(FrameCosts now, const FrameCosts& before) {
    now.allocations -= before.allocations;
    now.locks -= before.locks;
    now.faults -= before.faults;
    return now;
  }
  bool operator==(const FrameCosts&) const = default;
};

/// False with sanitizers, which have a malloc() of their own: everything counts as 0 then.
bool are_costs_counted();
/// The counts so far.
FrameCosts frame_costs();

/// Called by clock_gettime() of the thread that sets it; null: nothing is called. Costs of what is
/// called are counted.
extern thread_local void (*at_each_look_at_the_clock)();

}  // namespace handcast::test
