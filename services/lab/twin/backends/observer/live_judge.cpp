// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/backends/observer/live_judge.hpp"

#include <nlohmann/json.hpp>

namespace handcast::observer {

Result<std::unique_ptr<LiveJudge>> LiveJudge::create(const config::Rig& rig,
                                                     const calib::Calibration& calibration,
                                                     std::int64_t epoch_ns) {
  auto twin = twin::Twin::create(rig, calibration);
  if (!twin) return fail_in("observer", twin.error());
  auto judge = twin::Judge::create(**twin, rig.observer.step_px);
  return std::unique_ptr<LiveJudge>(new LiveJudge(std::move(*twin), std::move(judge), epoch_ns));
}

void LiveJudge::add(const msg::Projection& projection) {
  scores_.add(score(projection), static_cast<int>(projection.foldovers));
}

nlohmann::json LiveJudge::scores() const { return scores_.to_json(); }

Result<std::unique_ptr<Judge>> open_judge(const config::Rig& rig,
                                          const calib::Calibration& calibration,
                                          std::int64_t epoch_ns) {
  return LiveJudge::create(rig, calibration, epoch_ns);
}

}  // namespace handcast::observer
