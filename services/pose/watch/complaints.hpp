// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "ipc/msg/tracker_faults.hpp"

namespace handcast::pose {

/// Decides when a person is told of a source's faults: once when a kind becomes frequent, and once
/// when it has ended. One thread.
class Complaints {
 public:
  /// `source`: begins each sentence, e.g. "pose 'leapc'".
  explicit Complaints(std::string source) : source_(std::move(source)) {}

  /// Adds what has begun until `time_ns`. Returns the sentences for the log, usually none.
  std::vector<std::string> add(std::int64_t time_ns, const msg::TrackerFaults& faults);

 private:
  struct Kind {
    std::deque<std::int64_t> recent_ns;  ///< at most kMost
    std::uint64_t since_said = 0;
    bool is_said = false;
  };

  std::string source_;
  std::array<Kind, msg::kTrackerFaults> kinds_;
};

}  // namespace handcast::pose
