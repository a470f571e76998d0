// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <string_view>

#include "services/content/hands.hpp"
#include "services/lab/twin/motion.hpp"
#include "tests/renderer/hand_pose.hpp"

namespace handcast::content {

/// The true hands of the twin's motions, as a perfect tracker reports them.
class GesturingHands {
 public:
  explicit GesturingHands(std::string_view motion, double size = 1)
      : motion_(twin::make_builtin_motion(motion, {}, calibration_)), size_(size) {}

  /// The hand's joints at a time, enlarged about the tracker.
  std::optional<msg::HandPose> pose(Side side, double seconds) const {
    auto joints = motion_->at(side, seconds);
    if (!joints) return std::nullopt;
    for (auto& frame : *joints)
      frame[3] = glm::vec4(static_cast<float>(size_) * glm::vec3(frame[3]), 1);
    return renderer::pose_of(side, *joints);
  }
  msg::HandPoses sample(double seconds) const {
    msg::HandPoses poses;
    poses.header.origin_ns = poses.header.published_ns = ns(seconds);
    for (const Side side : {Side::left, Side::right})
      if (const auto found = pose(side, seconds)) poses.hands[poses.count++] = *found;
    return poses;
  }
  /// Gives 0.3 s of samples at 100 Hz, up to `seconds`.
  void follow(Hands& hands, double seconds) const {
    for (int k = 30; k >= 0; --k) hands.push(sample(seconds - 0.01 * k));
  }

  const calib::Calibration& calibration() const { return calibration_; }
  static std::int64_t ns(double seconds) {
    return 1'000'000'000 + static_cast<std::int64_t>(1e9 * seconds);
  }

 private:
  calib::Calibration calibration_ = calib::reference_rig();
  std::unique_ptr<twin::Motion> motion_;
  double size_;
};

}  // namespace handcast::content
