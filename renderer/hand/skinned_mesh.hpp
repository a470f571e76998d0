// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "renderer/hand/gltf_file.hpp"
#include "renderer/hand/hand_axes.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// What a skinned mesh of a file is as the hand of a side.
struct SkinnedMesh {
  HandMesh hand;
  FoundJoints found{};
  /// Per joint of the skin: index into kJointNames; 255: of the other hand.
  std::vector<std::uint8_t> ours;
  std::vector<std::uint32_t> alien;  ///< vertices that move with the other hand, ascending
  float scale = 1;                   ///< from the mesh to metres
  std::size_t covered = 0;           ///< number of joints that move some of its vertices
};

/// Reads the mesh of a node as the hand of a side. The error is the end of a sentence.
tl::expected<SkinnedMesh, std::string> read_skinned_mesh(const tinygltf::Model& model,
                                                         const tinygltf::Node& node, Side side);

/// Joints that the model lacks get the frames of their parents.
void fill_missing_joints(SkinnedMesh& mesh);

}  // namespace handcast::renderer
