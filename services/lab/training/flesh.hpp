// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "renderer/hand/hand_mesh.hpp"
#include "services/lab/training/dice.hpp"
#include "services/lab/twin/true_hands.hpp"

namespace handcast::landmarks::training {

/// Parts of the skin that reflect differently.
enum class Skin : std::uint8_t { plain, nail, knuckle, crease };

/// A right hand's surface, and what the drawing of it needs to know of each vertex.
struct FleshModel {
  renderer::HandMesh mesh;      ///< the surface and the joints at rest
  std::vector<Skin> skin;       ///< of each vertex
  std::vector<float> behind_m;  ///< distance of each vertex behind the wrist

  explicit FleshModel(renderer::HandMesh surface);
};

/// The flesh of a hand in one image.
struct Flesh {
  const FleshModel* model;  ///< whose vertices it has
  twin::TrueHand hand;      ///< on the bones of the person
};

/// Draws flesh for the bones of a person, whose own model is `own`: in half of the images `own`, as
/// it is or with other widths, thicknesses and turns of the fingers; else that of the implicit hand
/// (twin::implicit_hand()), so that the network does not learn one surface by heart.
Flesh draw_flesh(Dice& dice, const FleshModel& own);

}  // namespace handcast::landmarks::training
