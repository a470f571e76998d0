// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/correct/deform.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"

/// @file
/// The mean hand at rest, seen from above without perspective, and masks of hands like it.

namespace handcast::renderer {

inline constexpr int kSize_px = 640;

inline glm::vec2 seen_from_above_px(const glm::vec3& place_m) {
  constexpr float kPxPerM = 2600;
  return {320 + kPxPerM * place_m.x, 560 + kPxPerM * place_m.z};
}

/// A drawn hand: its vertices and landmarks before any correction.
struct SeenHand {
  HandMesh mesh = make_hand(HandShape::mean(), Side::left);
  std::vector<glm::vec2> vertices_px;
  LandmarkPoints landmarks_px{};

  SeenHand() {
    for (const auto& position : mesh.positions) vertices_px.push_back(seen_from_above_px(position));
    for (std::size_t i = 0; i < landmarks_px.size(); ++i)
      landmarks_px[i] = seen_from_above_px(glm::vec3(mesh.rest[msg::kJointOfLandmark[i]][3]));
  }

  /// Made once.
  static const SeenHand& mean() {
    static const SeenHand hand;
    return hand;
  }

  /// The vertices when the landmarks are moved.
  std::vector<glm::vec2> moved_to(const LandmarkPoints& landmarks) const {
    auto moved = vertices_px;
    correct_vertices({}, mesh, landmarks_px, landmarks, moved);
    return moved;
  }
};

inline float turn(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

inline Image<std::uint8_t> mask_of(const HandMesh& mesh, std::span<const glm::vec2> px) {
  Image<std::uint8_t> mask(kSize_px, kSize_px);
  for (const auto& [i, j, k] : mesh.triangles) {
    const glm::vec2 a = px[i], b = px[j], c = px[k];
    const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    for (int y = std::max(0, int(low.y)); y <= std::min(kSize_px - 1, int(high.y) + 1); ++y)
      for (int x = std::max(0, int(low.x)); x <= std::min(kSize_px - 1, int(high.x) + 1); ++x) {
        const glm::vec2 p(x, y);
        const float u = turn(b - a, p - a), v = turn(c - b, p - b), w = turn(a - c, p - c);
        if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) mask.at(x, y) = 255;
      }
  }
  return mask;
}

}  // namespace handcast::renderer
