// SPDX-License-Identifier: Apache-2.0
#include "services/pose/lift/lifter.hpp"

namespace handcast::pose {

Result<Lifter> Lifter::open(const config::Rig& rig, const calib::Calibration& calibration) {
  const auto left = renderer::load_hand_or_default(rig.hand.left, msg::Side::left);
  if (!left) return fail_in("left hand", left.error());
  const auto right = renderer::load_hand_or_default(rig.hand.right, msg::Side::right);
  if (!right) return fail_in("right hand", right.error());
  return Lifter({HandLifter(*left, rig.pose.none, calibration),
                 HandLifter(*right, rig.pose.none, calibration)});
}

msg::HandPoses Lifter::lift(const msg::Landmarks& landmarks) {
  msg::HandPoses poses;
  poses.header = {landmarks.header.frame_id, landmarks.header.origin_ns, 0};
  for (const auto side : {msg::Side::left, msg::Side::right})
    if (const auto* seen = landmarks.find(side))
      if (const auto pose =
              hands_[static_cast<std::size_t>(side)].lift(poses.header.origin_ns, *seen))
        poses.hands[poses.count++] = *pose;
  return poses;
}

}  // namespace handcast::pose
