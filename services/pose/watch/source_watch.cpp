// SPDX-License-Identifier: Apache-2.0
#include "services/pose/watch/source_watch.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "renderer/predict/plausible_pose.hpp"

namespace handcast::pose {
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
