// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/outline_parts.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::renderer {
namespace {

constexpr float kEdge = 128;  ///< level of the mask at its edge

/// The level of the mask at a place between pixels; negative outside the image.
float level_at(GreyView mask, glm::vec2 place) {
  if (!(place.x > 0 && place.y > 0 && place.x < static_cast<float>(mask.width - 1) &&
        place.y < static_cast<float>(mask.height - 1)))
    return -1;
  const glm::ivec2 at(place);
  const glm::vec2 part = place - glm::vec2(at);
  const std::uint8_t *row = mask.row(at.y) + at.x, *next = mask.row(at.y + 1) + at.x;
  const auto mix = [&](const std::uint8_t* two) {
    return static_cast<float>(two[0]) + part.x * static_cast<float>(two[1] - two[0]);
  };
  return glm::mix(mix(row), mix(next), part.y);
}

}  // namespace

std::vector<MeshEdge> edges_among(const HandMesh& mesh, const std::vector<bool>& among) {
  std::vector<MeshEdge> edges;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint16_t a = triangle[corner], b = triangle[(corner + 1) % 3];
      // a < b: the other triangle of this edge has (b, a).
      if (a < b && among[a] && among[b]) edges.push_back({a, b});
    }
  return edges;
}

float weight_of(const HandMesh& mesh, std::size_t vertex, std::span<const int> joints) {
  float weight = 0;
  for (std::size_t k = 0; k < 4; ++k)
    if (std::ranges::find(joints, static_cast<int>(mesh.joints[vertex][k])) != joints.end())
      weight += mesh.weights[vertex][k];
  return weight;
}

Section section_of(std::span<const MeshEdge> edges, std::span<const glm::vec2> vertices_px,
                   const Axes& axes, float at_px) {
  Section section;
  const glm::vec2 origin = axes.origin + at_px * axes.along;
  for (const auto& [a, b] : edges) {
    const glm::vec2 from = vertices_px[a] - origin, to = vertices_px[b] - origin;
    const float before = glm::dot(from, axes.along), behind = glm::dot(to, axes.along);
    if (before * behind > 0 || before == behind) continue;
    const float side = glm::dot(glm::mix(from, to, before / (before - behind)), axes.across);
    section.low_px = std::min(section.low_px, side);
    section.high_px = std::max(section.high_px, side);
  }
  return section;
}

std::optional<float> edge_px(GreyView mask, glm::vec2 start, glm::vec2 way, float most_px) {
  float before = level_at(mask, start);
  if (before < 0) return std::nullopt;
  const bool is_inside = before >= kEdge;
  const float step = is_inside ? 1.0f : -1.0f;
  for (int i = 1; static_cast<float>(i) <= most_px; ++i) {
    const float far = step * static_cast<float>(i), now = level_at(mask, start + way * far);
    if (now < 0) return std::nullopt;
    if ((now >= kEdge) != is_inside) return far - step * (kEdge - now) / (before - now);
    before = now;
  }
  return std::nullopt;
}

float frontal_share(const LandmarkPoints& px) {
  constexpr float kEdgeOn = 0.4f, kFrontal = 0.6f;  // breadth of the knuckles / length of the palm
  const glm::vec2 along = 0.25f * (px[5] + px[9] + px[13] + px[17]) - px[0],
                  across = px[5] - px[17];
  const float length2 = glm::dot(along, along);
  if (!(length2 > 0)) return 0;
  return glm::smoothstep(kEdgeOn, kFrontal,
                         std::abs(along.x * across.y - along.y * across.x) / length2);
}

bool is_open(const LandmarkPoints& px) {
  constexpr float kReach = 1.3f;  // of a tip from the wrist, in lengths of the palm
  const glm::vec2 along = 0.25f * (px[5] + px[9] + px[13] + px[17]) - px[0];
  int reach = 0;
  for (const int tip : {8, 12, 16, 20})
    reach += glm::dot(px[tip] - px[0], along) > kReach * glm::dot(along, along);
  return reach >= 3;
}

float from_bone_px(glm::vec2 place, const LandmarkPoints& landmarks_px, int start, int end) {
  const glm::vec2 from = landmarks_px[start], way = landmarks_px[end] - from;
  const float length2 = glm::dot(way, way);
  const float along =
      length2 > 0 ? std::clamp(glm::dot(place - from, way) / length2, 0.0f, 1.0f) : 0.0f;
  return glm::distance(place, from + along * way);
}

void Lasting::add(float measured, float part) {
  share += part * (1 - share);
  if (share > 0) value += std::min(1.0f, part / share) * (measured - value);
}

}  // namespace handcast::renderer
