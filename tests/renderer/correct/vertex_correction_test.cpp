// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <random>

#include "renderer/correct/deform.hpp"
#include "renderer/correct/foldover_repair.hpp"
#include "tests/renderer/paper_hand.hpp"

namespace handcast::renderer {
namespace {

LandmarkPoints moved_at_random(const LandmarkPoints& p, float sigma_px, std::mt19937& random) {
  std::normal_distribution<float> normal(0, 1);
  const auto step = [&](float scale) { return glm::vec2(normal(random), normal(random)) * scale; };
  const glm::vec2 whole = step(0.5f * sigma_px);
  LandmarkPoints q = p;
  for (auto& point : q) point += whole;
  for (int finger = 0; finger < 5; ++finger) {
    const glm::vec2 tip = step(sigma_px);
    for (int k = 1; k <= 4; ++k)
      q[4 * finger + k] += tip * (static_cast<float>(k) / 4) + step(0.15f * sigma_px);
  }
  return q;
}

TEST(VertexCorrection, NothingMovesWhereTheLandmarksAgree) {
  const auto p = open_hand_px();
  PaperHand hand = make_paper_hand(p);
  auto vertices = hand.positions_px;
  correct_vertices({}, hand.mesh, p, p, vertices);
  for (std::size_t v = 0; v < vertices.size(); ++v)
    EXPECT_LT(glm::distance(vertices[v], hand.positions_px[v]), 2e-3f);
}

TEST(VertexCorrection, SkinAtALandmarkGoesToItsTarget) {
  const auto p = open_hand_px();
  PaperHand hand = make_paper_hand(p);
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const auto q = moved_at_random(p, 12, random);
    auto vertices = hand.positions_px;
    correct_vertices({}, hand.mesh, p, q, vertices);
    for (int finger = 0; finger < 5; ++finger)
      for (int k = 1; k <= 4; ++k) {
        const int i = 4 * finger + k;
        EXPECT_LT(glm::distance(vertices[hand.vertex_at[i]], q[i]),
                  0.04f * glm::distance(p[i], q[i]) + 0.2f)
            << "landmark " << i;
      }
  }
}

TEST(VertexCorrection, NoTriangleTurnsOverInRandomFields) {
  const auto p = open_hand_px();
  PaperHand hand = make_paper_hand(p);
  std::mt19937 random(5);
  for (int trial = 0; trial < 200; ++trial) {
    auto vertices = hand.positions_px;
    correct_vertices({}, hand.mesh, p, moved_at_random(p, 8, random), vertices);
    EXPECT_EQ(flipped(hand.mesh, hand.positions_px, vertices), 0) << "field " << trial;
  }
}

TEST(VertexCorrection, FingersMayCross) {
  const auto p = open_hand_px();
  PaperHand hand = make_paper_hand(p);
  auto q = p;
  for (const auto& [landmark, px] :
       {std::pair{8, -59}, {7, -45}, {6, -15}, {12, 30}, {11, 20}, {10, 7}})
    q[landmark].x += static_cast<float>(px);
  auto vertices = hand.positions_px;
  correct_vertices({}, hand.mesh, p, q, vertices);
  EXPECT_GT(vertices[hand.vertex_at[12]].x, vertices[hand.vertex_at[8]].x);
  EXPECT_EQ(flipped(hand.mesh, hand.positions_px, vertices), 0);
}

/// The index finger points at the camera: its bones are seen at `share` of their length.
LandmarkPoints foreshortened(float share) {
  auto p = open_hand_px();
  for (int k = 6; k <= 8; ++k) p[k] = p[5] + share * (p[k] - p[5]);
  return p;
}

TEST(VertexCorrection, AForeshortenedBoneIsLeftToTheFieldAroundIt) {
  const auto p = foreshortened(0.04f);  // phalanges of 1 to 3 px
  PaperHand hand = make_paper_hand(p);
  auto q = p;
  // 6 px across a bone that is 2 px long: the similarity of the bone would be far off.
  q[7] += glm::vec2(6, 4);
  auto vertices = hand.positions_px;
  correct_vertices({}, hand.mesh, p, q, vertices);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    EXPECT_TRUE(std::isfinite(vertices[v].x));
    EXPECT_LT(glm::distance(vertices[v], hand.positions_px[v]), 25.0f);
  }
}

TEST(VertexCorrection, TheHandOverIsGradual) {
  LandmarkPoints before{};
  for (float share = 0.1f; share < 1.0f; share += 0.005f) {
    const auto p = foreshortened(share);
    PaperHand hand = make_paper_hand(p);
    auto q = p;
    for (int k = 6; k <= 8; ++k) q[k] += glm::vec2(4, -3);
    auto vertices = hand.positions_px;
    correct_vertices({}, hand.mesh, p, q, vertices);
    LandmarkPoints moved{};
    for (int k = 6; k <= 8; ++k) moved[k] = vertices[hand.vertex_at[k]] - p[k];
    for (int k = 6; k <= 8 && share > 0.1f; ++k)
      EXPECT_LT(glm::distance(moved[k], before[k]), 0.5f) << share;
    before = moved;
  }
}

TEST(VertexCorrection, AWildLandmarkDoesNotBlowABoneUp) {
  const auto p = open_hand_px();
  PaperHand hand = make_paper_hand(p);
  auto q = p;
  q[8] += glm::vec2(0, -400);
  auto vertices = hand.positions_px;
  correct_vertices({}, hand.mesh, p, q, vertices);
  const auto width_px = [&](const std::vector<glm::vec2>& v) {
    return glm::distance(v[hand.vertex_at[8] - 4], v[hand.vertex_at[8] + 4]);
  };
  EXPECT_LT(width_px(vertices), 2.05f * width_px(hand.positions_px));
}

/// The mesh of the hand at rest, its back seen without perspective: vertices and landmarks in px
/// (1.8 px/mm).
struct RealHand {
  HandMesh mesh = *load_hand_or_default({}, Side::left);
  std::vector<glm::vec2> vertices_px;
  LandmarkPoints landmarks_px;

  RealHand() {
    const auto seen = [](glm::vec3 m) {
      return glm::vec2(512, 600) + 1800.0f * glm::vec2(m.x, m.z);
    };
    for (const glm::vec3& position : mesh.positions) vertices_px.push_back(seen(position));
    for (int i = 0; i < kLandmarks; ++i)
      landmarks_px[i] = seen(glm::vec3(mesh.rest[msg::kJointOfLandmark[i]][3]));
  }

  /// The number of triangles that faced the camera (with negative area, y down) and no longer do.
  /// An area of 0.01 px^2 is ignored: it is not visible and within rounding errors.
  int turned_over(const std::vector<glm::vec2>& after) const {
    int count = 0;
    for (const auto& t : mesh.triangles)
      count += area(vertices_px, t) < 0 && area(after, t) > 0.02f;
    return count;
  }

  static float area(const std::vector<glm::vec2>& px, const std::array<std::uint16_t, 3>& t) {
    const glm::vec2 a = px[t[1]] - px[t[0]], b = px[t[2]] - px[t[0]];
    return a.x * b.y - a.y * b.x;
  }
};

TEST(VertexCorrection, OnTheRealMeshNoTriangleThatFacesTheCameraStaysTurnedOver) {
  RealHand hand;
  FoldoverRepair repair(hand.mesh);
  std::mt19937 random(9);
  for (const float sigma_px : {4.0f, 8.0f, 16.0f})
    for (int trial = 0; trial < 100; ++trial) {
      auto vertices = hand.vertices_px;
      correct_vertices({}, hand.mesh, hand.landmarks_px,
                       moved_at_random(hand.landmarks_px, sigma_px, random), vertices);
      EXPECT_EQ(repair.repair(hand.vertices_px, vertices, -1), 0) << sigma_px;
      EXPECT_EQ(hand.turned_over(vertices), 0) << sigma_px;
    }
}

TEST(VertexCorrection, AKnotThatSmoothingDoesNotMendIsShiftedAsOne) {
  RealHand hand;
  FoldoverRepair repair(hand.mesh);
  std::mt19937 random(12);
  for (int trial = 0; trial < 50; ++trial) {
    auto vertices = hand.vertices_px;
    std::normal_distribution<float> wild(0, 12);
    for (glm::vec2& vertex : vertices) vertex += glm::vec2(wild(random), wild(random));
    EXPECT_EQ(repair.repair(hand.vertices_px, vertices, -1), 0);
    EXPECT_EQ(hand.turned_over(vertices), 0);
  }
}

// Where a float has no room for a pixel, joined corners still look turned over.
TEST(VertexCorrection, RepairEndsAlsoFarOutsideTheScreen) {
  RealHand hand;
  FoldoverRepair repair(hand.mesh);
  std::mt19937 random(13);
  for (const float far : {1e6f, 1e9f, 1e20f, 1e38f}) {
    auto vertices = hand.vertices_px;
    std::normal_distribution<float> wild(0, far);
    for (glm::vec2& vertex : vertices) vertex += glm::vec2(wild(random), wild(random));
    repair.repair(hand.vertices_px, vertices, -1);
  }
}

TEST(VertexCorrection, RepairMovesSliversOnly) {
  RealHand hand;
  FoldoverRepair repair(hand.mesh);
  std::mt19937 random(10);
  double most_px = 0;
  for (int trial = 0; trial < 100; ++trial) {
    auto vertices = hand.vertices_px;
    correct_vertices({}, hand.mesh, hand.landmarks_px,
                     moved_at_random(hand.landmarks_px, 8, random), vertices);
    const auto corrected = vertices;
    repair.repair(hand.vertices_px, vertices, -1);
    int moved = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const double px = glm::distance(vertices[v], corrected[v]);
      moved += px > 0;
      most_px = std::max(most_px, px);
    }
    EXPECT_LT(moved, 120);
  }
  EXPECT_LT(most_px, 6);
}

TEST(VertexCorrection, AMeshOfMoreTrianglesThanSixteenBitsNumberIsRepaired) {
  constexpr int kSide = 200;
  HandMesh mesh;
  std::vector<glm::vec2> before;
  const auto at = [](int x, int y) { return static_cast<std::uint16_t>(kSide * y + x); };
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      mesh.positions.emplace_back(x, y, 0);
      before.emplace_back(4 * x, 4 * y);
      if (x == 0 || y == 0) continue;
      mesh.triangles.push_back({at(x - 1, y - 1), at(x, y - 1), at(x, y)});
      mesh.triangles.push_back({at(x - 1, y - 1), at(x, y), at(x - 1, y)});
    }
  ASSERT_GT(mesh.triangles.size(), 65536u);
  auto after = before;
  after[at(100, kSide - 2)] += glm::vec2(9, 7);
  EXPECT_EQ(FoldoverRepair(mesh).repair(before, after, 1), 0);
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::vec2 u = after[b] - after[a], v = after[c] - after[a];
    ASSERT_GT(u.x * v.y - u.y * v.x, -0.02f);
  }
}

TEST(VertexCorrection, RepairKeepsSeamsClosed) {
  RealHand hand;
  FoldoverRepair repair(hand.mesh);
  std::mt19937 random(11);
  std::map<std::array<float, 3>, std::size_t> first_at;
  for (int trial = 0; trial < 50; ++trial) {
    auto vertices = hand.vertices_px;
    correct_vertices({}, hand.mesh, hand.landmarks_px,
                     moved_at_random(hand.landmarks_px, 12, random), vertices);
    repair.repair(hand.vertices_px, vertices, -1);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const glm::vec3& at = hand.mesh.positions[v];
      const std::size_t twin = first_at.emplace(std::array{at.x, at.y, at.z}, v).first->second;
      ASSERT_LT(glm::distance(vertices[v], vertices[twin]), 1e-2f);
    }
  }
}

TEST(VertexCorrection, AnyNumberIsSurvived) {
  const LandmarkPoints together{};  // all landmarks coincide
  PaperHand hand = make_paper_hand(open_hand_px());
  auto vertices = hand.positions_px;
  correct_vertices({}, hand.mesh, together, open_hand_px(), vertices);
  for (const auto& vertex : vertices)
    EXPECT_TRUE(std::isfinite(vertex.x) && std::isfinite(vertex.y));
}

}  // namespace
}  // namespace handcast::renderer
