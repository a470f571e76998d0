// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "services/lab/twin/backends/observer/live_score.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/observer/judge.hpp"

namespace handcast::observer {

/// Scores the live light against the true hand of the twin, whose clock starts at the epoch of the
/// rig. One thread.
class LiveJudge final : public Judge {
 public:
  /// `epoch_ns`: the epoch of the rig, CLOCK_MONOTONIC. Errors: bad_config (the motion of the twin
  /// cannot be read).
  static Result<std::unique_ptr<LiveJudge>> create(const config::Rig& rig,
                                                   const calib::Calibration& calibration,
                                                   std::int64_t epoch_ns);

  void add(const msg::Projection& projection) override;
  bool empty() const override { return scores_.empty(); }
  nlohmann::json scores() const override;

  /// Scores one projected frame.
  twin::FrameScore score(const msg::Projection& projection) {
    return judge_->score(projection, epoch_ns_);
  }

 private:
  LiveJudge(std::unique_ptr<twin::Twin> twin, std::unique_ptr<twin::Judge> judge,
            std::int64_t epoch_ns)
      : twin_(std::move(twin)), judge_(std::move(judge)), epoch_ns_(epoch_ns) {}

  std::unique_ptr<twin::Twin> twin_;  ///< must outlive the judge
  std::unique_ptr<twin::Judge> judge_;
  std::int64_t epoch_ns_;
  LiveScore scores_;
};

}  // namespace handcast::observer
