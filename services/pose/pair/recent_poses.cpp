// SPDX-License-Identifier: Apache-2.0
#include "services/pose/pair/recent_poses.hpp"

#include <algorithm>

#include "services/pose/pair/joint_offsets.hpp"

namespace handcast::pose {
namespace {

constexpr std::int64_t kSpan_ns = 250'000'000, kBeside_ns = 20'000'000;
/// Samples farther apart are not interpolated.
constexpr std::int64_t kGap_ns = 60'000'000;

}  // namespace

void RecentPoses::add(std::int64_t origin_ns, const msg::HandPose& pose) {
  if (!poses_.empty() && origin_ns <= newest_ns()) return;
  poses_.push_back({origin_ns, pose});
  while (poses_.front().origin_ns < origin_ns - kSpan_ns) poses_.pop_front();
}

std::optional<msg::HandPose> RecentPoses::at(std::int64_t time_ns) const {
  const auto after = std::ranges::lower_bound(poses_, time_ns, {}, &Timed::origin_ns);
  if (after == poses_.end()) {
    const bool is_near = !poses_.empty() && time_ns - newest_ns() <= kBeside_ns;
    return is_near ? std::optional(poses_.back().pose) : std::nullopt;
  }
  if (after == poses_.begin()) {
    const bool is_near = after->origin_ns - time_ns <= kBeside_ns;
    return is_near ? std::optional(after->pose) : std::nullopt;
  }
  const auto before = std::prev(after);
  const std::int64_t step_ns = after->origin_ns - before->origin_ns;
  if (step_ns > kGap_ns) return std::nullopt;
  const double share =
      static_cast<double>(time_ns - before->origin_ns) / static_cast<double>(step_ns);
  return JointOffsets::between(after->pose, before->pose)
      .applied(after->pose, static_cast<float>(1 - share));
}

}  // namespace handcast::pose
