// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>
#include <vector>

#include "renderer/skin/skinning.hpp"
#include "services/content/hands.hpp"
#include "tests/services/content/made_hand.hpp"

namespace handcast::content {

/// A hand at rest, 0.6 m in front of the camera with its back to it, and the tip of another one's
/// index finger, which can be put anywhere.
struct TouchingHands {
  TouchingHands() {
    const auto& mesh = made_hand(Side::left);
    const glm::mat4 held{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0.08f, 0.6f, 1}};
    auto frames = mesh.rest;
    for (auto& frame : frames) frame = held * glm::inverse(mesh.rest[1]) * frame;
    positions_m.resize(mesh.vertex_count());
    normals.resize(mesh.vertex_count());
    renderer::skin(mesh, frames, positions_m, normals);
    hand.is_there = other.is_there = true;
    hand.mesh = &mesh;
    other.mesh = &made_hand(Side::right);
    other.side = Side::right;
    hand.positions_m = positions_m;
    hand.normals = normals;
    for (std::size_t joint = 0; joint < kJoints; ++joint)
      hand.joints_m[joint] = glm::vec3(frames[joint][3]);
    other.joints_m.fill({1, 1, 1});
    moment.hand = &hand;
    moment.other = &other;
  }
  TouchingHands(const TouchingHands&) = delete;
  TouchingHands& operator=(const TouchingHands&) = delete;

  /// The vertex whose skin is nearest to a place in camera space.
  std::size_t vertex_near(const glm::vec3& place_m) const {
    std::size_t nearest = 0;
    for (std::size_t v = 0; v < positions_m.size(); ++v)
      if (glm::distance(positions_m[v], place_m) < glm::distance(positions_m[nearest], place_m))
        nearest = v;
    return nearest;
  }
  /// A vertex in the middle of the back, or of the palm.
  std::size_t middle(bool of_back) const {
    const glm::vec3 palm = hand.joints_m[0];
    return vertex_near(palm + glm::vec3(0, 0, of_back ? -0.05f : 0.05f));
  }
  /// Puts the tip `above_m` over a vertex.
  void touch(std::size_t vertex, float above_m = 0.004f) {
    other.joints_m[10] = positions_m[vertex] + above_m * normals[vertex];
  }
  void lift() { other.joints_m[10] = {1, 1, 1}; }

  std::vector<glm::vec3> positions_m, normals;
  HandState hand, other;
  Moment moment;
};

}  // namespace handcast::content
