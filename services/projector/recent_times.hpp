// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "ipc/base/statistics.hpp"

namespace handcast::projector {

/// The median of the last 31 times, which a single slow frame does not change.
class RecentTimes {
 public:
  /// Starts as if all times so far had been `first_ns`.
  explicit RecentTimes(std::int64_t first_ns) : median_ns_(first_ns) { recent_ns_.fill(first_ns); }

  /// The median.
  std::int64_t median_ns() const { return median_ns_; }
  /// Adds a time.
  void add(std::int64_t time_ns) {
    recent_ns_[count_++ % recent_ns_.size()] = time_ns;
    median_ns_ = median(recent_ns_);
  }

 private:
  std::array<std::int64_t, 31> recent_ns_{};
  std::size_t count_ = 0;
  std::int64_t median_ns_;
};

}  // namespace handcast::projector
