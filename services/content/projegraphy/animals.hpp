// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::projegraphy {

/// How a hand is held before the projector to look like an animal. Degrees, relative to the hand at
/// rest; fingers: 0 thumb, 1 index, … 4 little. Angles are those of a left hand; a right hand is
/// held as its mirror image.
struct HeldHand {
  std::array<std::array<float, 3>, 5> flexion{};  ///< MCP, PIP, DIP (thumb: MCP, IP, unused)
  std::array<float, 5> splay{};                   ///< at the MCP, to the thumb
  float thumb_flexion = 0;                        ///< at its root, in the plane of its nail
  float thumb_opposition = 0;                     ///< at its root, across the palm
  /// Of a hand whose back is seen with its fingers up: first about the length of the hand (90: it
  /// is seen from the side of the thumb), then towards the viewer, then clockwise in the picture.
  /// @{
  float turn = 0, nod = 0, spin = 0;
  /// @}
  glm::vec2 wrist_m{0};  ///< in the picture, x to the right, y down
};

/// The joints of a hand with the bones of a mesh, in the camera's axes and with the wrist at
/// (wrist_m, 0). A mesh of the right hand is held as the mirror image of the angles alone: turn,
/// spin and wrist_m are not mirrored.
renderer::JointFrames joints_of(const renderer::HandMesh& mesh, const HeldHand& held);

/// An animal of the shadow play.
struct Animal {
  std::string_view name;
  std::vector<HeldHand> hands;  ///< one, or the left and the right one
  /// Silhouettes that are farther (Recognised::distance) are none of it: the mean and three
  /// standard deviations of people 1 to 20 of the twin who hold it, two tries each.
  float farthest = 0;
};

/// All that can be recognised.
std::span<const Animal> animals();
/// The index of an animal by its name, -1 if there is none.
int animal_of(std::string_view name);

}  // namespace handcast::projegraphy
