// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/ros_joints.hpp"

#include <dds/dds.h>
#include <fmt/format.h>
#include <time.h>

#include <array>
#include <span>
#include <string>

#include "ipc/base/clock.hpp"
#include "ros.h"

namespace handcast::bridge {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// A time of CLOCK_MONOTONIC on the clock of ROS 2, which is that of the system.
std::int64_t system_ns(std::int64_t monotonic_ns) {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return now.tv_sec * kSecond_ns + now.tv_nsec - (now_ns() - monotonic_ns);
}

/// As rclcpp's default, so that its readers match; a slow one never holds the sender up.
dds_qos_t* reliable() {
  auto* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  return qos;
}

}  // namespace

Result<std::unique_ptr<RosJoints>> RosJoints::open(std::int32_t participant) {
  auto joints = std::make_unique<RosJoints>();
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto topic = dds_create_topic(participant, &geometry_msgs_msg_dds__PoseArray__desc,
                                        kTopics[static_cast<std::size_t>(side)], nullptr, nullptr);
    auto* qos = reliable();
    const auto writer = dds_create_writer(participant, topic, qos, nullptr);
    dds_delete_qos(qos);
    if (writer < 0)
      return fail(Errc::unavailable, fmt::format("CycloneDDS: {}", dds_strretcode(-writer)));
    joints->writers_[side] = writer;
  }
  return joints;
}

void RosJoints::send(const msg::HandPoses& poses) {
  const auto stamp_ns = system_ns(poses.header.origin_ns);
  std::string frame = kFrame;
  for (const auto& hand : std::span(poses.hands).first(std::min(poses.count, 2u))) {
    const auto writer = writers_.find(hand.side);
    if (writer == writers_.end()) continue;
    std::array<geometry_msgs_msg_dds__Pose_, msg::kJoints> joints{};
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const auto& [position, orientation, radius] = hand.joints[i];
      joints[i].position = {position[0], position[1], position[2]};
      joints[i].orientation = {orientation[0], orientation[1], orientation[2], orientation[3]};
    }
    geometry_msgs_msg_dds__PoseArray_ message{};
    message.header.stamp.sec = static_cast<std::int32_t>(stamp_ns / kSecond_ns);
    message.header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % kSecond_ns);
    message.header.frame_id = frame.data();
    message.poses._maximum = message.poses._length = joints.size();
    message.poses._buffer = joints.data();
    dds_write(writer->second, &message);
  }
}

}  // namespace handcast::bridge
