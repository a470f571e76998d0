// SPDX-License-Identifier: Apache-2.0
#include "services/observer/judge.hpp"

#include <cstring>

namespace handcast::observer {

Result<LiveJudge> LiveJudge::create(const config::Rig& rig, const calib::Calibration& calibration,
                                    std::int64_t epoch_ns) {
  auto twin = twin::Twin::create(rig, calibration);
  if (!twin) return fail_in("observer", twin.error());
  auto judge = twin::Judge::create(**twin, rig.observer.step_px);
  return LiveJudge(std::move(*twin), std::move(judge), epoch_ns);
}

twin::FrameScore LiveJudge::score(const msg::Projection& projection) {
  static_assert(alignof(msg::Projection) <= alignof(std::uint64_t));
  message_.resize(projection.used_bytes() / sizeof(std::uint64_t) + 1);
  std::memcpy(message_.data(), &projection, projection.used_bytes());
  auto& moved = *reinterpret_cast<msg::Projection*>(message_.data());
  moved.target_ns -= epoch_ns_;
  moved.lit_ns -= epoch_ns_;
  moved.header.origin_ns -= epoch_ns_;
  return judge_->score(moved);
}

}  // namespace handcast::observer
