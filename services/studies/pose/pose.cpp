// SPDX-License-Identifier: Apache-2.0
#include "services/studies/pose/pose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/hand/hand_posture.hpp"
#include "services/lab/twin/articulation.hpp"
#include "services/studies/base/study_table.hpp"

namespace handcast::study {
namespace {

constexpr std::size_t kWrist = 1;

float angle_rad(const glm::vec3& a, const glm::vec3& b) {
  const float lengths = glm::length(a) * glm::length(b);
  return lengths > 1e-6f ? std::acos(std::clamp(glm::dot(a, b) / lengths, -1.f, 1.f)) : 0;
}

glm::vec3 bone(const HeldPose& pose, const std::array<std::size_t, 2>& ends) {
  return pose.joints_mm[ends[1]] - pose.joints_mm[ends[0]];
}

/// Fingers of a pose: how far each is bent, 0 to 1, thumb to little finger.
HeldPose made_pose(const char* name, const std::array<double, 5>& bent, double apart = 0.06) {
  static const twin::Articulation articulation(renderer::HandShape::mean());
  twin::Bend bend;
  for (std::size_t finger = 1; finger < 5; ++finger) {
    bend.flexion[finger] = {1.35 * bent[finger], 1.65 * bent[finger], 1.0 * bent[finger]};
    bend.splay[finger] = apart * (2.4 - static_cast<double>(finger)) * (1 - bent[finger]);
  }
  bend.flexion[0] = {0.7 * bent[0], 0.9 * bent[0], 0};
  bend.thumb_opposition = 0.6 * bent[0];
  bend.thumb_flexion = 0.4 * bent[0];
  const auto frames = articulation.frames(msg::Side::left, glm::dmat4(1), bend);
  std::array<glm::vec3, msg::kJoints> joints{};
  std::ranges::transform(frames, joints.begin(), [](const auto& frame) { return frame[3]; });
  auto pose = held_pose(joints, msg::Side::left);
  pose.name = name;
  return pose;
}

CsvRow columns() {
  CsvRow row{"name"};
  for (std::size_t joint = 0; joint < msg::kJoints; ++joint)
    for (const char axis : {'x', 'y', 'z'}) row.push_back(fmt::format("{}{}_mm", axis, joint));
  return row;
}

}  // namespace

HeldPose held_pose(std::span<const glm::vec3, msg::kJoints> joints, msg::Side side) {
  HeldPose pose;
  const glm::mat3 palm_from_space = glm::transpose(renderer::palm_axes(joints, side));
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    pose.joints_mm[joint] = 1e3f * (palm_from_space * (joints[joint] - joints[kWrist]));
    if (side == msg::Side::right) pose.joints_mm[joint].x *= -1;
  }
  return pose;
}

PoseScore score_of(const HeldPose& wanted, const HeldPose& held) {
  PoseScore score{.worst_finger = 1};
  for (std::size_t b = 0; b < kBones.size(); ++b)
    score.bones[b] =
        1 - angle_rad(bone(wanted, kBones[b]), bone(held, kBones[b])) / std::numbers::pi_v<float>;
  for (std::size_t b = 0; b < kBones.size(); b += 3)
    score.worst_finger = std::min(score.worst_finger,
                                  (score.bones[b] + score.bones[b + 1] + score.bones[b + 2]) / 3);
  return score;
}

std::array<float, kFlexions> flexions_deg(const HeldPose& held) {
  std::array<float, kFlexions> flexions{};
  std::size_t next = 0;
  const auto add = [&](std::size_t first) {
    flexions[next++] =
        glm::degrees(angle_rad(bone(held, {first, first + 1}), bone(held, {first + 1, first + 2})));
  };
  add(2);
  add(3);
  for (const std::size_t metacarpal : {6u, 11u, 16u, 21u})
    for (std::size_t joint = 0; joint < 3; ++joint) add(metacarpal + joint);
  return flexions;
}

std::string flexion_name(std::size_t which) {
  constexpr std::array kFingers{"index", "middle", "ring", "little"};
  constexpr std::array kJoints{"MCP", "PIP", "DIP"};
  if (which < 2) return which == 0 ? "thumb MCP" : "thumb IP";
  return fmt::format("{} {}", kFingers[(which - 2) / 3], kJoints[(which - 2) % 3]);
}

std::vector<HeldPose> builtin_poses() {
  return {made_pose("open", {0, 0, 0, 0, 0}, 0.12),  made_pose("fist", {1, 1, 1, 1, 1}),
          made_pose("point", {1, 0, 1, 1, 1}),       made_pose("victory", {1, 0, 0, 1, 1}, 0.25),
          made_pose("three", {0, 0, 0, 1, 1}, 0.15), made_pose("horns", {1, 0, 1, 1, 0}),
          made_pose("call", {0, 1, 1, 1, 0}),        made_pose("thumb up", {0, 1, 1, 1, 1}),
          made_pose("ring", {0.6, 0.55, 0, 0, 0})};
}

Result<std::vector<HeldPose>> read_poses(const std::filesystem::path& file) {
  const auto table = read_study_table(file);
  if (!table) return tl::make_unexpected(table.error());
  if (table->columns != columns())
    return fail(Errc::bad_data, fmt::format("{}: the file has no poses", table->name));
  std::vector<HeldPose> poses;
  for (std::size_t row = 0; row < table->rows.size(); ++row) {
    HeldPose pose{.name = table->rows[row][0], .joints_mm = {}};
    for (std::size_t cell = 0; cell < 3 * msg::kJoints; ++cell) {
      const auto number = table->number(row, 1 + cell);
      if (!number) return tl::make_unexpected(number.error());
      pose.joints_mm[cell / 3][static_cast<int>(cell % 3)] = static_cast<float>(*number);
    }
    poses.push_back(std::move(pose));
  }
  if (poses.empty())
    return fail(Errc::bad_data, fmt::format("{}: the file has no poses", table->name));
  return poses;
}

Result<void> add_pose(const std::filesystem::path& file, const HeldPose& pose) {
  end_last_line(file);  // people edit it
  auto log = StudyLog::open(file, columns());
  if (!log) return tl::make_unexpected(log.error());
  CsvRow row{pose.name};
  for (const auto& joint : pose.joints_mm)
    for (int axis = 0; axis < 3; ++axis) row.push_back(fmt::format("{:.2f}", joint[axis]));
  return log->add(row);
}

}  // namespace handcast::study
