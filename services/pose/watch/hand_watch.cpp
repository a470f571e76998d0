// SPDX-License-Identifier: Apache-2.0
#include "services/pose/watch/hand_watch.hpp"

#include <algorithm>

namespace handcast::pose {
namespace {

using msg::TrackerFault;

/// A hand that comes back sooner was not gone.
constexpr std::int64_t kFlicker_ns = 200'000'000;
/// A hand at rest may be reported with the same numbers for this long.
constexpr std::int64_t kRest_ns = 1'000'000'000;
/// Nothing is concluded across a longer gap.
constexpr std::int64_t kGap_ns = 50'000'000;
/// Two samples that are closer give a velocity that is mostly noise.
constexpr std::int64_t kShortestBase_ns = 6'000'000;
constexpr std::int64_t kRecent_ns = 200'000'000;

bool is_repeated(const msg::HandPose& a, const msg::HandPose& b) {
  return std::ranges::equal(a.joints, b.joints, [](const auto& p, const auto& q) {
    return p.position_m == q.position_m && p.orientation_xyzw == q.orientation_xyzw;
  });
}

}  // namespace

void HandWatch::add(std::int64_t origin_ns, const msg::HandPose& pose, msg::TrackerFaults& faults) {
  if (is_missed_ && last_ && origin_ns - seen_ns_ < kFlicker_ns)
    ++faults.of(TrackerFault::flickered);
  is_missed_ = false;
  seen_ns_ = origin_ns;
  if (last_ && is_repeated(last_->pose, pose)) return judge_repeat(origin_ns, pose, faults);
  const bool was_frozen = frozen_ != Frozen::no;
  frozen_ = Frozen::no;
  if (was_frozen || (last_ && origin_ns - last_->origin_ns > kGap_ns)) last_.reset();
  judge_motion({origin_ns, pose}, faults);
}

void HandWatch::miss(std::int64_t) { is_missed_ = true; }

std::optional<msg::HandPose> HandWatch::recent(std::int64_t time_ns) const {
  return last_ && time_ns - seen_ns_ < kRecent_ns ? std::optional(last_->pose) : std::nullopt;
}

void HandWatch::judge_repeat(std::int64_t origin_ns, const msg::HandPose& pose,
                             msg::TrackerFaults& faults) {
  Frozen now = frozen_;
  if (renderer::Continuity::frozen(before_ ? &*before_ : nullptr, *last_, pose))
    now = Frozen::moving;
  else if (origin_ns - last_->origin_ns > kRest_ns && frozen_ == Frozen::no)
    now = Frozen::at_rest;
  if (frozen_ == Frozen::no && now != Frozen::no) ++faults.of(TrackerFault::frozen);
  frozen_ = now;
}

void HandWatch::judge_motion(const Sample& sample, msg::TrackerFaults& faults) {
  if (!last_) {
    before_.reset();
    last_ = sample;
    return;
  }
  const bool jumps = continuity_.broken(before_ ? &*before_ : nullptr, *last_, sample);
  if (jumps) {
    ++faults.of(TrackerFault::jumped);
    before_.reset();
  } else if (!before_ || sample.origin_ns - last_->origin_ns >= kShortestBase_ns) {
    before_ = last_;
  }
  last_ = sample;
}

}  // namespace handcast::pose
