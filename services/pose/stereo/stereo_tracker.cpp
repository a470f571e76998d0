// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/stereo_tracker.hpp"

#include <algorithm>

namespace handcast::pose::stereo {
namespace {

std::vector<ReportedHand> reports_of(const msg::Landmarks* landmarks) {
  std::vector<ReportedHand> reports;
  if (!landmarks) return reports;
  for (std::uint32_t i = 0; i < landmarks->count && i < landmarks->hands.size(); ++i) {
    const auto& hand = landmarks->hands[i];
    if (hand.side != msg::Side::left && hand.side != msg::Side::right) continue;
    if (const auto seen = read(hand))
      reports.push_back({hand.side, std::clamp<double>(hand.presence, 0, 1), *seen});
  }
  return reports;
}

}  // namespace

Seen seen_of(const Pair& pair) {
  return {pair[0] ? &*pair[0] : nullptr, pair[1] ? &*pair[1] : nullptr};
}

Result<StereoTracker> StereoTracker::open(const config::Rig& rig, const Views& views,
                                          const glm::dmat4& tracker_from_first) {
  const auto left = renderer::load_hand_or_default(rig.hand.left, msg::Side::left);
  if (!left) return fail_in("left hand", left.error());
  const auto right = renderer::load_hand_or_default(rig.hand.right, msg::Side::right);
  if (!right) return fail_in("right hand", right.error());
  const auto hand = [&](const renderer::HandMesh& mesh) {
    return StereoHand(mesh, rig.pose.stereo, views, tracker_from_first);
  };
  return StereoTracker(views, {hand(*left), hand(*right)});
}

std::array<Expected, msg::kMaxHands> StereoTracker::expected(std::int64_t time_ns) const {
  return {hands_[0].expected(time_ns), hands_[1].expected(time_ns)};
}

msg::HandPoses StereoTracker::sample(const Seen& seen) {
  msg::HandPoses poses;
  for (const auto* landmarks : seen)
    if (landmarks)
      poses.header.origin_ns = std::max(poses.header.origin_ns, landmarks->header.origin_ns);
  poses.header.frame_id = samples_++;
  const Reports reports{reports_of(seen[0]), reports_of(seen[1])};
  const Matches matches =
      match(hands_[0].skeleton(), views_, reports, expected(poses.header.origin_ns));
  for (int side = 0; side < msg::kMaxHands; ++side) {
    Looks looks;
    for (int v = 0; v < kViews; ++v)
      if (matches[side][v] >= 0)
        looks[v] =
            Look{reports[v][static_cast<std::size_t>(matches[side][v])], seen[v]->header.origin_ns};
    if (const auto pose = hands_[side].follow(poses.header.origin_ns, looks))
      poses.hands[poses.count++] = *pose;
  }
  return poses;
}

}  // namespace handcast::pose::stereo
