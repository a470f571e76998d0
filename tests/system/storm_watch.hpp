// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>

#include "tests/system/storm_crew.hpp"

namespace handcast::storm {

/// Measures from outside how long a reader sleeps although its ring has a newer message than its
/// last one. Time in which the reader is stopped, or runnable without a processor, does not count,
/// because the ring does not cause it.
class Watch {
 public:
  explicit Watch(const Seat& reader) : reader_(reader) {}

  /// Call it often.
  void look(std::int64_t now_ns);
  /// The longest such sleep so far.
  std::int64_t longest_ns() const { return longest_ns_; }
  /// The number of such sleeps that ended by the time limit of 100 ms and not by a wake-up.
  int late() const { return late_; }

 private:
  bool sleeps_beside_something_new() const;

  const Seat& reader_;
  std::uint64_t turn_ = 0;
  pid_t pid_ = 0;
  std::int64_t since_ns_ = 0;  ///< begin of such a sleep; 0: none
  std::int64_t longest_ns_ = 0;
  bool counted_ = false;
  int late_ = 0;
};

}  // namespace handcast::storm
