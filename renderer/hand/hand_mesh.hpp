// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"

namespace handcast::renderer {

using msg::kJoints;
using msg::Side;

/// WebXR's joint names in the order of XR_EXT_hand_tracking.
extern const std::array<std::string_view, kJoints> kJointNames;
/// The joint each hangs from; -1 for the wrist, the root.
extern const std::array<int, kJoints> kJointParent;

/// A skinned hand at rest. Space: metres, OpenXR hand axes (+x right, +y out of the back, -z to the
/// tips), wrist at the origin in the hands handcast makes. Texture coordinates: u right, v down,
/// 0..1.
struct HandMesh {
  Side side = Side::left;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uv;
  std::vector<std::array<std::uint8_t, 4>>
      joints;  ///< up to four joints a vertex, unused ones have weight 0
  std::vector<std::array<float, 4>> weights;  ///< sum to 1
  std::vector<std::uint8_t>
      chart;  ///< connected part of the UV layout: 1 back, 2 palm, ... (0 is never used)
  std::vector<std::array<std::uint16_t, 3>> triangles;  ///< counter-clockwise seen from outside
  std::array<glm::mat4, kJoints> rest{};                ///< joint to model space at rest

  std::size_t vertex_count() const { return positions.size(); }
};

/// Reads a skinned glTF/GLB hand whose joints bear WebXR's names (with or without the prefix of a
/// side); the first skinned mesh of the file. The metacarpals of the little finger and others a
/// file lacks are taken from their parents. Errors (bad_config): no file, no glTF, no skin, joints
/// missing (named), more than 65,535 vertices, index out of range.
Result<HandMesh> load_hand(const std::filesystem::path& file, Side side);

/// The hands made at build time: HANDCAST_ASSETS or beside the program or the installed share
/// folder.
std::filesystem::path default_hand_file(Side side);
/// load_hand of `file`, or of the default where it is empty.
Result<HandMesh> load_hand_or_default(const std::filesystem::path& file, Side side);

/// A joint's place: rotation and position, to the space the poses are given in.
using JointFrames = std::array<glm::mat4, kJoints>;

/// The frames a pose message holds, in tracker space.
JointFrames frames_of(const msg::HandPose& pose);

}  // namespace handcast::renderer
