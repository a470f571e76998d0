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
/// The parent of each joint; -1 for the wrist, which is the root.
extern const std::array<int, kJoints> kJointParent;

/// A skinned hand at rest. Model space: metres, OpenXR hand axes (+x right, +y out of the back, -z
/// towards the tips). The wrist is at the origin in the hands made by services/lab/hand_maker.
struct HandMesh {
  Side side = Side::left;            ///< which hand it is
  std::vector<glm::vec3> positions;  ///< per vertex, model space
  std::vector<glm::vec3> normals;    ///< per vertex, unit length, outwards
  std::vector<glm::vec2> uv;         ///< per vertex, texture coordinates 0..1, u right, v down
  /// Per vertex: the joints that move it. Unused entries have weight 0.
  std::vector<std::array<std::uint8_t, 4>> joints;
  /// Per vertex: the weights of these joints, with sum 1.
  std::vector<std::array<float, 4>> weights;
  /// Per vertex: the connected part of the UV layout, see number_charts(). 0 is not used. In the
  /// hands made by services/lab/hand_maker 1 is the back and 2 the palm.
  std::vector<std::uint8_t> chart;
  std::vector<std::array<std::uint16_t, 3>> triangles;  ///< counter-clockwise seen from outside
  std::array<glm::mat4, kJoints> rest{};                ///< joint space to model space, rigid

  /// Number of vertices: the size of every array per vertex.
  std::size_t vertex_count() const { return positions.size(); }
};

/// Reads a hand from a glTF or GLB file: of its skinned meshes with the joints of this side that
/// which most of them move. The joints have the names of WebXR, with or without a side before or
/// behind; the palm, the tips and the metacarpals of the fingers may be missing: they get the frame
/// of their parent. The axes of the joints are settled (settle_axes()). Errors (bad_config): no
/// such file, not glTF, no skinned mesh, a required extension that is not read, other joints
/// missing (the message names them), a hand of the other side, more than 65,535 vertices, an index
/// out of range, a number that is not finite, a mesh that cannot be a hand (fault_of_mesh(),
/// fault_when_bent()).
Result<HandMesh> load_hand(const std::filesystem::path& file, Side side);

/// The hand that is made at build time: in the folder named by the environment variable
/// HANDCAST_ASSETS if it is set, else in ../share/handcast as seen from the program's folder.
std::filesystem::path default_hand_file(Side side);
/// load_hand() of `file`, or of default_hand_file() if `file` is empty.
Result<HandMesh> load_hand_or_default(const std::filesystem::path& file, Side side);

/// Per joint: the transform from joint space to the space of the pose, rigid.
using JointFrames = std::array<glm::mat4, kJoints>;

/// The frames of a pose message, in tracker space. Quaternions are normalised.
JointFrames frames_of(const msg::HandPose& pose);

}  // namespace handcast::renderer
