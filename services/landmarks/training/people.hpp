// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"
#include "services/evaluation/twin/articulation.hpp"
#include "services/landmarks/training/dice.hpp"

namespace handcast::landmarks::training {

/// What of the skin reflects differently.
enum class Skin : std::uint8_t { plain, nail, knuckle, crease };

/// One person's right hand.
struct Person {
  renderer::HandMesh mesh;
  twin::Articulation articulation;
  std::array<float, renderer::kJoints> radius_m;
  std::vector<Skin> skin;       ///< of each vertex
  std::vector<float> behind_m;  ///< how far each vertex lies behind the wrist
};

/// Different lengths of fingers and palm, slim and broad hands. A quarter of a second each. Errors:
/// the hand model cannot be read.
Result<std::vector<Person>> draw_people(int count, std::uint64_t seed);

/// Finger f, phalanx k (0 proximal): the joint it begins at.
inline constexpr std::array<int, 5> kFirstPhalanx{3, 7, 12, 17, 22};
inline constexpr std::array<int, 5> kTip{5, 10, 15, 20, 25};

}  // namespace handcast::landmarks::training
