// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "renderer/filter/landmark_filter.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// The 21 landmarks of an open hand seen from its back, projector px (about 1.8 px/mm).
inline LandmarkPoints open_hand_px() {
  constexpr std::array<std::array<float, 2>, kLandmarks> mm{
      {{0, 0},      {23, -20},   {48, -51},   {63, -74},   {72, -93},   {29, -86},   {35, -126},
       {38, -150},  {41, -170},  {8.5, -89},  {9.7, -134}, {10, -161},  {11, -183},  {-11, -84},
       {-15, -126}, {-18, -151}, {-20, -173}, {-29, -74},  {-37, -106}, {-41, -124}, {-46, -142}}};
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i)
    points[i] = glm::vec2(512, 500) + 1.8f * glm::vec2(mm[i][0], mm[i][1]);
  return points;
}

/// A flat hand: a sheet along every finger, skinned to the joints under it.
struct PaperHand {
  HandMesh mesh;
  std::vector<glm::vec2> positions_px;
  std::array<int, kLandmarks> vertex_at{};  ///< the vertex that lies on a landmark (fingers only)
};

inline void add_vertex(PaperHand& hand, glm::vec2 at, std::array<std::uint8_t, 4> joints,
                       std::array<float, 4> weights) {
  hand.positions_px.push_back(at);
  hand.mesh.positions.push_back({at, 0});
  hand.mesh.joints.push_back(joints);
  hand.mesh.weights.push_back(weights);
}

inline void add_sheet(PaperHand& hand, int first, int columns, int rows) {
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = static_cast<std::uint16_t>(first + row * columns + column),
                 b = static_cast<std::uint16_t>(a + columns);
      hand.mesh.triangles.push_back({a, static_cast<std::uint16_t>(a + 1), b});
      hand.mesh.triangles.push_back(
          {static_cast<std::uint16_t>(a + 1), static_cast<std::uint16_t>(b + 1), b});
    }
}

/// Weights of finger joints fade over 12 px to either side of a knuckle.
inline void add_finger(PaperHand& hand, const LandmarkPoints& p, int finger) {
  const int knuckle = 1 + 4 * finger, first = static_cast<int>(hand.positions_px.size());
  for (int bone = 0; bone < 3; ++bone)
    for (int step = bone ? 1 : 0; step <= 8; ++step) {
      const glm::vec2 from = p[knuckle + bone], to = p[knuckle + bone + 1];
      const glm::vec2 along = glm::normalize(to - from), side{-along.y, along.x};
      const float length = glm::distance(from, to), at = length * static_cast<float>(step) / 8;
      const float before = bone > 0 ? 0.5f * std::max(0.0f, 1 - at / 12) : 0,
                  after = bone < 2 ? 0.5f * std::max(0.0f, 1 - (length - at) / 12) : 0;
      const auto joint = static_cast<std::uint8_t>(msg::kJointOfLandmark[knuckle + bone]);
      for (int across = -4; across <= 4; ++across) {
        if (across == 0 && step == 0)
          hand.vertex_at[knuckle] = static_cast<int>(hand.positions_px.size());
        if (across == 0 && step == 8)
          hand.vertex_at[knuckle + bone + 1] = static_cast<int>(hand.positions_px.size());
        add_vertex(
            hand, from + along * at + side * (3.5f * static_cast<float>(across)),
            {joint, static_cast<std::uint8_t>(joint - 1), static_cast<std::uint8_t>(joint + 1), 0},
            {1 - before - after, before, after, 0});
      }
    }
  add_sheet(hand, first, 9, 25);
}

inline PaperHand make_paper_hand(const LandmarkPoints& p) {
  PaperHand hand;
  for (int finger = 0; finger < 5; ++finger) add_finger(hand, p, finger);
  return hand;
}

/// The number of triangles whose orientation differs between two sets of vertex positions.
inline int flipped(const HandMesh& mesh, const std::vector<glm::vec2>& before,
                   const std::vector<glm::vec2>& after) {
  const auto area = [](const auto& v, const auto& t) {
    const glm::vec2 a = v[t[1]] - v[t[0]], b = v[t[2]] - v[t[0]];
    return a.x * b.y - a.y * b.x;
  };
  int count = 0;
  for (const auto& triangle : mesh.triangles)
    count += area(before, triangle) * area(after, triangle) < 0;
  return count;
}

}  // namespace handcast::renderer
