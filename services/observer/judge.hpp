// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "services/evaluation/twin/metrics.hpp"

namespace handcast::observer {

/// Scores the live light: what the projector reports on the host's clock, against a truth on the
/// twin's. One thread.
class LiveJudge {
 public:
  /// Errors: bad_config (the twin's motion).
  static Result<LiveJudge> create(const config::Rig& rig, const calib::Calibration& calibration,
                                  std::int64_t epoch_ns);

  twin::FrameScore score(const msg::Projection& projection);

 private:
  LiveJudge(std::unique_ptr<twin::Twin> twin, std::unique_ptr<twin::Judge> judge,
            std::int64_t epoch_ns)
      : twin_(std::move(twin)), judge_(std::move(judge)), epoch_ns_(epoch_ns) {}

  std::unique_ptr<twin::Twin> twin_;  ///< outlives the judge
  std::unique_ptr<twin::Judge> judge_;
  std::int64_t epoch_ns_;
  std::vector<std::uint64_t> message_;  ///< a copy with its times moved, aligned as the message is
};

}  // namespace handcast::observer
