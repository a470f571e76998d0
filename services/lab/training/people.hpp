// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"
#include "services/lab/training/dice.hpp"
#include "services/lab/twin/articulation.hpp"

namespace handcast::landmarks::training {

/// Parts of the skin that reflect differently.
enum class Skin : std::uint8_t { plain, nail, knuckle, crease };

/// One person's right hand.
struct Person {
  renderer::HandMesh mesh;                        ///< the surface and the joints at rest
  twin::Articulation articulation;                ///< how its joints bend
  std::array<float, renderer::kJoints> radius_m;  ///< of the flesh around each joint
  std::vector<Skin> skin;                         ///< of each vertex
  std::vector<float> behind_m;                    ///< distance of each vertex behind the wrist
};

/// Draws hands that differ in the lengths of fingers and palm and in their widths. Takes a quarter
/// of a second for each. Errors: the hand model cannot be read.
Result<std::vector<Person>> draw_people(int count, std::uint64_t seed);

/// The joints at the root of each finger's first phalanx and at its tip, thumb first.
/// @{
inline constexpr std::array<int, 5> kFirstPhalanx{3, 7, 12, 17, 22};
inline constexpr std::array<int, 5> kTip{5, 10, 15, 20, 25};
/// @}

}  // namespace handcast::landmarks::training
