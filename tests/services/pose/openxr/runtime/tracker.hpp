// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "tests/services/pose/openxr/runtime/motion.hpp"
#include "tests/services/pose/openxr/runtime/script.hpp"

namespace handcast::test_runtime {

/// A tracker that samples a motion, and what a runtime makes of its samples. Times are ns of the
/// motion. Everything is a function of its arguments.
class Tracker {
 public:
  explicit Tracker(Motion motion) : motion_(std::move(motion)) {}

  /// The hand that the runtime reports for a time at the time `now_ns`; empty: none.
  std::optional<msg::HandPose> hand(const Script& script, msg::Side side, std::int64_t time_ns,
                                    std::int64_t now_ns) const;

 private:
  std::optional<msg::HandPose> truth(msg::Side side, double time_s) const;
  std::optional<msg::HandPose> sample(const Script& script, msg::Side side, std::int64_t k) const;
  std::optional<msg::HandPose> between(const Script& script, msg::Side side, double place) const;

  Motion motion_;
};

}  // namespace handcast::test_runtime
