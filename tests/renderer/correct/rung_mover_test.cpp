// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/rung_mover.hpp"

#include <gtest/gtest.h>

#include "config/sections/cascade.hpp"
#include "renderer/correct/deform.hpp"
#include "tests/renderer/open_hand.hpp"

namespace handcast::renderer {
namespace {

/// The drawn hand, 400 px tall, and the part that moves each vertex alone: finger 0..4, -1 the
/// palm, -2 several parts.
struct DrawnHand2d {
  HandMesh mesh = *load_hand_or_default({}, Side::left);
  std::vector<glm::vec2> vertices;
  std::vector<int> owner;

  DrawnHand2d() {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      vertices.emplace_back(400 + 2000 * mesh.positions[v].x, 500 + 2000 * mesh.positions[v].z);
      int owned = -3;
      for (int k = 0; k < 4; ++k) {
        if (mesh.weights[v][k] == 0) continue;
        const int finger = finger_of(mesh.joints[v][k]);
        owned = owned == -3 || owned == finger ? finger : -2;
      }
      owner.push_back(owned);
    }
  }
  static int finger_of(int joint) {
    if (joint < 2 || joint == 6 || joint == 11 || joint == 16 || joint == 21) return -1;
    return joint < 6 ? 0 : (joint - 1) / 5;
  }
};

TEST(RungMover, ALostFingerIsFollowedByItsSkinAndByNoOther) {
  DrawnHand2d hand;
  RungModel model;
  model.whole.shift = {3, 0};
  model.fingers[1] = {0, 20};
  auto vertices = hand.vertices;
  RungMover(hand.mesh).move(model, vertices);
  int on_finger = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const glm::vec2 moved = vertices[v] - hand.vertices[v];
    EXPECT_NEAR(moved.x, 3, 1e-3f);
    if (hand.owner[v] >= -1) {
      EXPECT_NEAR(moved.y, hand.owner[v] == 1 ? 20 : 0, 0.02f)
          << "vertex " << v << " of " << hand.owner[v];
    }
    on_finger += hand.owner[v] == 1;
  }
  EXPECT_GT(on_finger, 50);
}

TEST(RungMover, MovingTheVerticesDirectlyIsWhatCorrectingThemOntoTheModelsLandmarksDoes) {
  DrawnHand2d hand;
  const LandmarkPoints p = open_hand();
  const RungModel model =
      fit_rung(Rung::similarity, p, with_noise(moved(p, {1.03f, -0.06f, {5, 9}}), 3));
  auto directly = hand.vertices, by_landmarks = hand.vertices;
  RungMover(hand.mesh).move(model, directly);
  correct_vertices(config::Correct{}, hand.mesh, p, model.moved(p), by_landmarks);
  for (std::size_t v = 0; v < directly.size(); ++v)
    ASSERT_LT(glm::distance(directly[v], by_landmarks[v]), 0.02f) << "vertex " << v;
}

}  // namespace
}  // namespace handcast::renderer
