// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"

namespace handcast::study {

/// How a hand is held: its joints in the axes of the palm (renderer::palm_axes()), mm from the
/// wrist, as of a left hand.
struct HeldPose {
  std::string name;
  std::array<glm::vec3, msg::kJoints> joints_mm{};
};

/// The pose in tracked joints, any space, m.
HeldPose held_pose(std::span<const glm::vec3, msg::kJoints> joints, msg::Side side);

/// The bones that are compared: three by finger, thumb to little finger; from joint to joint.
inline constexpr std::array<std::array<std::size_t, 2>, 15> kBones{{{2, 3},
                                                                    {3, 4},
                                                                    {4, 5},
                                                                    {7, 8},
                                                                    {8, 9},
                                                                    {9, 10},
                                                                    {12, 13},
                                                                    {13, 14},
                                                                    {14, 15},
                                                                    {17, 18},
                                                                    {18, 19},
                                                                    {19, 20},
                                                                    {22, 23},
                                                                    {23, 24},
                                                                    {24, 25}}};

/// How well a hand matches a pose, wherever and however it is turned: by bone 1 - angle / pi.
struct PoseScore {
  std::array<float, kBones.size()> bones{};
  float worst_finger = 0;  ///< the least mean of the bones of a finger
};
PoseScore score_of(const HeldPose& wanted, const HeldPose& held);

/// The flexion of the joints, degrees: MCP, PIP, DIP of index to little finger, before them MCP and
/// IP of the thumb.
inline constexpr std::size_t kFlexions = 14;
std::array<float, kFlexions> flexions_deg(const HeldPose& held);
std::string flexion_name(std::size_t which);

/// The nine poses of the game: open, fist, point, victory, three, horns, call, thumb up, ring.
std::vector<HeldPose> builtin_poses();

/// Poses that somebody has taught, a CSV file. Errors: bad_data (not such a file), bad_config.
/// @{
Result<std::vector<HeldPose>> read_poses(const std::filesystem::path& file);
Result<void> add_pose(const std::filesystem::path& file, const HeldPose& pose);
/// @}

}  // namespace handcast::study
