// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/hand_layout.hpp"

#include <map>

namespace handcast::study {
namespace {

constexpr std::size_t kPalm = 0, kWrist = 1;
/// By finger, in the order of OpenXR: the joint before the tip, and the tip.
constexpr std::array<std::array<std::size_t, 2>, 5> kEnds{
    {{4, 5}, {9, 10}, {14, 15}, {19, 20}, {24, 25}}};
constexpr float kPalmReach_m = 0.025f, kTipReach_m = 0.011f;
constexpr float kFacing = 0.35f;  ///< least cosine of a normal with the direction of its face

/// A place of the hand, and the axes of who looks at it.
struct Place {
  glm::vec3 middle_m, right, up, out;
  float reach_m;
};

/// The affine map from mm to px that fits the vertices around a place best, of the chart that has
/// most of them there.
Patch fitted(const renderer::HandMesh& mesh, const Place& place, const glm::vec2& size_px) {
  struct Sums {
    glm::dmat3 squares{0};
    glm::dmat3x2 products{0};
    int count = 0;
  };
  std::map<std::uint8_t, Sums> by_chart;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const glm::vec3 away = mesh.positions[v] - place.middle_m;
    if (glm::dot(mesh.normals[v], place.out) < kFacing) continue;
    const glm::dvec2 flat_mm =
        1e3f * glm::vec2(glm::dot(away, place.right), glm::dot(away, place.up));
    if (glm::length(flat_mm) > 1e3 * place.reach_m || glm::length(away) > 2.5f * place.reach_m)
      continue;
    const glm::dvec3 row(flat_mm, 1);
    Sums& sums = by_chart[mesh.chart.empty() ? 0 : mesh.chart[v]];
    sums.squares += glm::outerProduct(row, row);
    sums.products += glm::outerProduct(glm::dvec2(mesh.uv[v] * size_px), row);
    ++sums.count;
  }
  const Sums* best = nullptr;
  for (const auto& [chart, sums] : by_chart)
    if (!best || sums.count > best->count) best = &sums;
  if (!best || best->count < 4 || glm::abs(glm::determinant(best->squares)) < 1e-6)
    return {.middle_px = {-1e6f, -1e6f}};
  const glm::dmat3x2 map = best->products * glm::inverse(best->squares);
  return {.middle_px = glm::vec2(map[2]) - 0.5f, .px_per_mm = glm::mat2(map[0], map[1])};
}

}  // namespace

HandLayout::HandLayout(const renderer::HandMesh& mesh, int width_px, int height_px) {
  const glm::vec2 size_px(width_px, height_px);
  const glm::mat3 wrist(mesh.rest[kWrist]);
  const auto at = [&](std::size_t joint) { return glm::vec3(mesh.rest[joint][3]); };
  for (const auto face : {Face::back, Face::palm}) {
    const auto f = static_cast<std::size_t>(face);
    const float sign = face == Face::back ? 1 : -1;
    const glm::vec3 out = sign * wrist[1];
    palms_[f] = fitted(mesh, {at(kPalm), sign * wrist[0], -wrist[2], out, kPalmReach_m}, size_px);
    for (std::size_t finger = 0; finger < kFingers; ++finger) {
      const auto [before, tip] = kEnds[finger];
      const glm::vec3 up = glm::normalize(at(tip) - at(before));
      // The back of a finger is where its last joint says; a thumb is turned against the palm.
      glm::vec3 away = sign * glm::vec3(mesh.rest[before][1]);
      away = glm::normalize(away - glm::dot(away, up) * up);
      tips_[f][finger] = fitted(
          mesh, {glm::mix(at(before), at(tip), 0.55f), glm::cross(up, away), up, away, kTipReach_m},
          size_px);
    }
  }
}

}  // namespace handcast::study
