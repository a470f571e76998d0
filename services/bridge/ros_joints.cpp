// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/ros_joints.hpp"

#include <dds/dds.h>
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "ipc/base/clock.hpp"
#include "renderer/hand/hand_mesh.hpp"
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

builtin_interfaces_msg_dds__Time_ stamp_of(std::int64_t monotonic_ns) {
  const auto time_ns = system_ns(monotonic_ns);
  return {static_cast<std::int32_t>(time_ns / kSecond_ns),
          static_cast<std::uint32_t>(time_ns % kSecond_ns)};
}

/// The name of a frame as a field of a message, which is only read.
char* field(const char* name) { return const_cast<char*>(name); }

/// A writer, reliable as rclcpp's default, so that its readers match; a slow one never holds the
/// sender up. `depth`: how many messages wait for it.
Result<std::int32_t> open_writer(std::int32_t participant, const dds_topic_descriptor_t& type,
                                 const char* name, int depth) {
  auto* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
  const auto topic = dds_create_topic(participant, &type, name, nullptr, nullptr);
  const auto writer = dds_create_writer(participant, topic, qos, nullptr);
  dds_delete_qos(qos);
  if (writer >= 0) return writer;
  return fail(Errc::unavailable, fmt::format("CycloneDDS: {}", dds_strretcode(-writer)));
}

}  // namespace

std::string RosJoints::frame_of(msg::Side side, std::size_t joint) {
  auto name = fmt::format("handcast_{}_{}", side == msg::Side::left ? "left" : "right",
                          renderer::kJointNames[joint]);
  std::ranges::replace(name, '-', '_');
  return name;
}

Result<std::unique_ptr<RosJoints>> RosJoints::open(std::int32_t participant) {
  auto joints = std::make_unique<RosJoints>();
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto index = static_cast<std::size_t>(side);
    const auto writer =
        open_writer(participant, geometry_msgs_msg_dds__PoseArray__desc, kTopics[index], 1);
    if (!writer) return tl::make_unexpected(writer.error());
    joints->poses_[index] = *writer;
    for (std::size_t i = 0; i < msg::kJoints; ++i) joints->names_[index][i] = frame_of(side, i);
  }
  const auto writer = open_writer(participant, tf2_msgs_msg_dds__TFMessage__desc, kTransforms, 10);
  if (!writer) return tl::make_unexpected(writer.error());
  joints->transforms_ = *writer;
  return joints;
}

void RosJoints::send(const msg::HandPoses& poses) {
  const std_msgs_msg_dds__Header_ header{stamp_of(poses.header.origin_ns), field(kFrame)};
  std::array<geometry_msgs_msg_dds__TransformStamped_, msg::kMaxHands * msg::kJoints> frames{};
  std::uint32_t count = 0;
  for (const auto& hand : std::span(poses.hands).first(std::min(poses.count, 2u))) {
    const auto index = static_cast<std::size_t>(hand.side);
    if (index >= poses_.size()) continue;
    std::array<geometry_msgs_msg_dds__Pose_, msg::kJoints> joints{};
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const auto& [position, orientation, radius] = hand.joints[i];
      joints[i].position = {position[0], position[1], position[2]};
      joints[i].orientation = {orientation[0], orientation[1], orientation[2], orientation[3]};
      const auto& [x, y, z] = joints[i].position;
      frames[count++] = {
          header, field(names_[index][i].c_str()), {{x, y, z}, joints[i].orientation}};
    }
    geometry_msgs_msg_dds__PoseArray_ message{header, {}};
    message.poses._maximum = message.poses._length = joints.size();
    message.poses._buffer = joints.data();
    dds_write(poses_[index], &message);
  }
  if (count == 0) return;
  tf2_msgs_msg_dds__TFMessage_ message{};
  message.transforms._maximum = message.transforms._length = count;
  message.transforms._buffer = frames.data();
  dds_write(transforms_, &message);
}

}  // namespace handcast::bridge
