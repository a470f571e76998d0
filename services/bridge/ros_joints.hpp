// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"

namespace handcast::bridge {

/// The joints for computers with ROS 2, as two standard messages; the stamp is the sample time by
/// the system's clock. One thread.
///
/// - /handcast/left/joints and /handcast/right/joints: a geometry_msgs/PoseArray of 26 poses in the
///   order of XR_EXT_hand_tracking, in metres, in the frame "handcast_tracker"
/// - /tf: tf2_msgs/TFMessage, a frame for each joint, as frame_of() names it, in that frame
class RosJoints {
 public:
  static constexpr const char* kTopics[] = {"rt/handcast/left/joints", "rt/handcast/right/joints"};
  static constexpr const char* kTransforms = "rt/tf";
  static constexpr const char* kFrame = "handcast_tracker";
  /// "handcast_left_index_finger_tip"
  static std::string frame_of(msg::Side side, std::size_t joint);

  /// `participant`: of DDS. Errors: unavailable.
  static Result<std::unique_ptr<RosJoints>> open(std::int32_t participant);

  /// Sends the joints of each hand that is seen.
  void send(const msg::HandPoses& poses);

 private:
  /// A writer of DDS, by side.
  std::array<std::int32_t, 2> poses_{};
  std::int32_t transforms_ = 0;
  std::array<std::array<std::string, msg::kJoints>, 2> names_;
};

}  // namespace handcast::bridge
