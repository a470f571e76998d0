// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>

#include "tests/system/storm_crew.hpp"

namespace handcast::storm {

/// Sees from outside how long a reader sleeps although its ring holds something newer than what it
/// has seen. A reader that is runnable and gets no processor, or is stopped, does not count: that
/// is the machine's doing, not the ring's.
class Watch {
 public:
  explicit Watch(const Seat& reader) : reader_(reader) {}

  /// Call it often.
  void look(std::int64_t now_ns);
  /// The longest such sleep so far.
  std::int64_t longest_ns() const { return longest_ns_; }
  /// How many were long enough to be ended by the reader's own second look after 100 ms instead of
  /// a wake-up.
  int late() const { return late_; }

 private:
  bool sleeps_beside_something_new() const;

  const Seat& reader_;
  std::uint64_t turn_ = 0;
  pid_t pid_ = 0;
  std::int64_t since_ns_ = 0;  ///< 0: it does not sleep through anything
  std::int64_t longest_ns_ = 0;
  bool counted_ = false;
  int late_ = 0;
};

}  // namespace handcast::storm
