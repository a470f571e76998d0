// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"

namespace handcast::bridge {

/// The joints for computers with ROS 2: /handcast/left/joints and /handcast/right/joints, each a
/// geometry_msgs/PoseArray of 26 poses in the order of XR_EXT_hand_tracking, in metres, in the
/// frame "handcast_tracker"; the stamp is the sample time by the system's clock. One thread.
class RosJoints {
 public:
  static constexpr const char* kTopics[] = {"rt/handcast/left/joints", "rt/handcast/right/joints"};
  static constexpr const char* kFrame = "handcast_tracker";

  /// `participant`: of DDS. Errors: unavailable.
  static Result<std::unique_ptr<RosJoints>> open(std::int32_t participant);

  /// Sends the joints of each hand that is seen.
  void send(const msg::HandPoses& poses);

 private:
  std::map<msg::Side, std::int32_t> writers_;
};

}  // namespace handcast::bridge
