// SPDX-License-Identifier: Apache-2.0
#include "services/pose/watch/source_watch.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "renderer/predict/plausible_pose.hpp"

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

namespace {

using msg::TrackerFault;

/// After so many samples the usual age is known.
constexpr int kKnown = 30;
/// So much more than the usual age is late; so much less is a wrong stamp.
constexpr double kLate_ns = 20e6;
/// Sources that predict stamp their samples with a time in the future, but not more: the renderer
/// takes none that is later.
constexpr std::int64_t kFuture_ns = 50'000'000;
/// Tracker space is around the camera: a pose is judged where it is.
const glm::dmat4 kHere{1};

void remove_impossible(msg::HandPoses& poses, msg::TrackerFaults& faults) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(poses.count, msg::kMaxHands); ++i)
    if (renderer::is_plausible(poses.hands[i], kHere))
      poses.hands[kept++] = poses.hands[i];
    else
      ++faults.of(TrackerFault::impossible);
  poses.count = kept;
}

}  // namespace

msg::TrackerFaults SourceWatch::look(msg::HandPoses& poses, std::int64_t arrival_ns) {
  msg::TrackerFaults faults;
  if (poses.header.origin_ns - arrival_ns > kFuture_ns) {
    ++faults.of(TrackerFault::late);
    poses.count = 0;
    poses.header.origin_ns = arrival_ns;
    is_usable_ = false;
    return faults;
  }
  judge_age(arrival_ns - poses.header.origin_ns, faults);
  remove_impossible(poses, faults);
  const auto as_before = named(poses, faults);
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    auto& watch = hands_[static_cast<std::size_t>(side)];
    if (const auto* hand = as_before.find(side))
      watch.add(poses.header.origin_ns, *hand, faults);
    else
      watch.miss(poses.header.origin_ns);
  }
  is_usable_ = poses.count > 0;
  for (std::uint32_t i = 0; i < poses.count; ++i) {
    const auto side = static_cast<std::size_t>(as_before.hands[i].side);
    const auto frozen = hands_[side].frozen();
    if (frozen == HandWatch::Frozen::no) continue;
    is_usable_ = false;
    auto& confidence = poses.hands[i].confidence;
    confidence = std::min(confidence, frozen == HandWatch::Frozen::moving ? kFrozen : kAtRest);
  }
  return faults;
}

void SourceWatch::judge_age(std::int64_t age_ns, msg::TrackerFaults& faults) {
  const auto age = static_cast<double>(age_ns);
  const bool is_known = ages_ == kKnown;
  if (is_known && std::abs(age - usual_age_ns_) > kLate_ns) ++faults.of(TrackerFault::late);
  ages_ = std::min(ages_ + 1, kKnown);
  usual_age_ns_ += (age - usual_age_ns_) / ages_;
}

msg::HandPoses SourceWatch::named(const msg::HandPoses& poses, msg::TrackerFaults& faults) {
  const std::int64_t time_ns = poses.header.origin_ns;
  auto as_before = sides_.named(poses, {hands_[0].recent(time_ns), hands_[1].recent(time_ns)});
  const bool is_exchanged = poses.count > 0 && as_before.hands[0].side != poses.hands[0].side;
  if (is_exchanged && !is_exchanged_) ++faults.of(TrackerFault::exchanged);
  is_exchanged_ = is_exchanged;
  return as_before;
}

}  // namespace handcast::pose
