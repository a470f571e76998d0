// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/implicit/implicit_hand.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "services/lab/twin/implicit/limb.hpp"
#include "services/lab/twin/implicit/surface_nets.hpp"
#include "services/lab/twin/surface.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

using renderer::HandMesh;

TEST(Limb, MeasuresTheDistanceToAnEllipsoid) {
  const Limb ball({1, 2, 3}, glm::dmat3(1), {{0, 10, 10, 10}}, 10, 10);
  EXPECT_NEAR(ball.distance_mm({1, 2, 18}), 5, 1e-9);
  EXPECT_NEAR(ball.distance_mm({1, 9, 3}), -3, 1e-9);
  const Limb egg({0, 0, 0}, glm::dmat3(1), {{0, 4, 6, 3}}, 5, 20);
  for (const glm::dvec3 skin : {glm::dvec3(4, 0, 0), glm::dvec3(0, 6, 0), glm::dvec3(0, -3, 0),
                                glm::dvec3(0, 0, 5), glm::dvec3(0, 0, -20)}) {
    EXPECT_NEAR(egg.distance_mm(skin), 0, 1e-9);
    EXPECT_NEAR(egg.distance_mm(skin * 1.01), 0.01 * glm::length(skin), 2e-3);
    EXPECT_LT(egg.distance_mm(skin * 0.5), 0);
  }
}

TEST(Limb, GoesThroughItsSections) {
  const Limb limb({0, 0, 0}, glm::dmat3(1), {{0, 8, 7, 9}, {20, 6, 5, 7}, {45, 7, 6, 6}}, 5, 5);
  EXPECT_NEAR(limb.distance_mm({6, 0, -20}), 0, 1e-9);
  EXPECT_NEAR(limb.distance_mm({0, 5, -20}), 0, 1e-9);
  EXPECT_NEAR(limb.distance_mm({0, -7, -20}), 0, 1e-9);
  EXPECT_LT(limb.distance_mm({6.5, 0, -10}), 0) << "between 6 and 8 mm wide";
  EXPECT_GT(limb.distance_mm({8, 0, -10}), 0);
  EXPECT_EQ(limb.along_mm({3, 4, -12}), 12);
}

/// How often each edge of a mesh is passed in each direction: once, if the mesh is closed.
template <class Triangles>
bool is_closed(const Triangles& triangles) {
  std::map<std::pair<int, int>, int> passed;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++passed[{t[k], t[(k + 1) % 3]}];
  return std::ranges::all_of(passed, [&](const auto& edge) {
    const auto back = passed.find({edge.first.second, edge.first.first});
    return edge.second == 1 && back != passed.end() && back->second == 1;
  });
}

TEST(SurfaceNet, OfABallIsClosedAndLiesOnIt) {
  const auto ball = surface_net([](const glm::dvec3& p) { return glm::length(p) - 10; },
                                glm::dvec3(-13), glm::dvec3(13), 2.5);
  EXPECT_GT(ball.points.size(), 150u);
  EXPECT_TRUE(is_closed(ball.triangles));
  double six = 0;
  for (const auto& [a, b, c] : ball.triangles)
    six += glm::dot(ball.points[a], glm::cross(ball.points[b], ball.points[c]));
  EXPECT_NEAR(six / 6 / 4188.8, 1, 0.04) << "of its volume; negative if it is inside out";
  for (const auto& point : ball.points) ASSERT_NEAR(glm::length(point), 10, 1e-3);
}

TEST(ImplicitHand, IsOneClosedSurfaceWithNormalsThatPointOutwards) {
  const HandMesh& hand = implicit_hand();
  EXPECT_TRUE(is_closed(hand.triangles));
  // One piece: its vertices hang together.
  std::vector<std::size_t> piece(hand.vertex_count());
  std::iota(piece.begin(), piece.end(), std::size_t{0});
  const auto root = [&](std::size_t v) {
    while (piece[v] != v) v = piece[v] = piece[piece[v]];
    return v;
  };
  for (const auto& [a, b, c] : hand.triangles) {
    piece[root(a)] = root(b);
    piece[root(b)] = root(c);
  }
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) ASSERT_EQ(root(v), root(0)) << v;
  int against = 0;
  for (const auto& [a, b, c] : hand.triangles)
    against += glm::dot(glm::cross(hand.positions[b] - hand.positions[a],
                                   hand.positions[c] - hand.positions[a]),
                        hand.normals[a] + hand.normals[b] + hand.normals[c]) <= 0;
  EXPECT_EQ(against, 0) << "of " << hand.triangles.size() << " triangles";
}

TEST(ImplicitHand, FollowsTheBonesThatItsVerticesAreNearTo) {
  const HandMesh& hand = implicit_hand();
  const auto fingers = fingers_of(hand);
  const auto behind = behind_wrist_m(hand);
  constexpr std::array<int, 5> kFirst{3, 7, 12, 17, 22}, kTip{5, 10, 15, 20, 25};
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    const auto& weights = hand.weights[v];
    ASSERT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0f), 1, 1e-5);
    if (behind[v] > 0.02f) {
      ASSERT_EQ(hand.joints[v][0], 1) << "the forearm follows the wrist";
    }
    for (std::size_t f = 0; f < 5; ++f) {
      const glm::vec3 from(hand.rest[kFirst[f]][3]), to(hand.rest[kTip[f]][3]);
      const glm::vec3 along = glm::normalize(to - from), away = hand.positions[v] - from;
      const float share = glm::dot(away, along) / glm::distance(from, to);
      const float off_m = glm::length(away - glm::dot(away, along) * along);
      if (share > 0.5f && off_m < 0.012f) {
        ASSERT_EQ(fingers[v], static_cast<int>(f)) << v;
        for (std::size_t k = 0; k < 4; ++k)
          ASSERT_TRUE(weights[k] < 0.02f ||
                      (hand.joints[v][k] >= kFirst[f] - 1 && hand.joints[v][k] <= kTip[f]))
              << "joint " << int(hand.joints[v][k]) << " moves a vertex of finger " << f;
      }
    }
  }
}

TEST(ImplicitHand, ItsSkinIsAtOtherDistancesFromTheJointsThanThatOfTheDrawnHand) {
  const HandMesh& hand = implicit_hand();
  const HandMesh drawn = *renderer::load_hand_or_default({}, Side::left);
  // Of points of the triangles: other vertices on the same skin are no other hand.
  const auto nearest_m = [](const HandMesh& mesh, int joint) {
    constexpr int kParts = 4;  // of a triangle's edge
    const glm::vec3 from(mesh.rest[joint][3]);
    float nearest = 1;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto& corner = mesh.positions[a];
      const auto along = (mesh.positions[b] - corner) / static_cast<float>(kParts),
                 across = (mesh.positions[c] - corner) / static_cast<float>(kParts);
      for (int i = 0; i <= kParts; ++i)
        for (int j = 0; i + j <= kParts; ++j) {
          const auto skin = corner + static_cast<float>(i) * along + static_cast<float>(j) * across;
          nearest = std::min(nearest, glm::distance(skin, from));
        }
    }
    return nearest;
  };
  for (const int joint : {3, 8, 13, 18, 23})
    EXPECT_GT(std::abs(nearest_m(hand, joint) / nearest_m(drawn, joint) - 1), 0.05f) << joint;
}

}  // namespace
}  // namespace handcast::twin
