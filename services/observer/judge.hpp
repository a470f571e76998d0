// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "services/evaluation/twin/metrics.hpp"

namespace handcast::observer {

/// Scores the live light against the true hand of the twin. Converts the times of the projector
/// (CLOCK_MONOTONIC) to the clock of the twin, which starts at the epoch of the rig. One thread.
class LiveJudge {
 public:
  /// `epoch_ns`: the epoch of the rig, CLOCK_MONOTONIC. Errors: bad_config (the motion of the twin
  /// cannot be read).
  static Result<LiveJudge> create(const config::Rig& rig, const calib::Calibration& calibration,
                                  std::int64_t epoch_ns);

  /// Scores one projected frame.
  twin::FrameScore score(const msg::Projection& projection);

 private:
  LiveJudge(std::unique_ptr<twin::Twin> twin, std::unique_ptr<twin::Judge> judge,
            std::int64_t epoch_ns)
      : twin_(std::move(twin)), judge_(std::move(judge)), epoch_ns_(epoch_ns) {}

  std::unique_ptr<twin::Twin> twin_;  ///< must outlive the judge
  std::unique_ptr<twin::Judge> judge_;
  std::int64_t epoch_ns_;
  std::vector<std::uint64_t> message_;  ///< an aligned copy of the message, with shifted times
};

}  // namespace handcast::observer
