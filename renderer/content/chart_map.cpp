// SPDX-License-Identifier: Apache-2.0
#include "renderer/content/chart_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/draw/cpu/nearest_pixel.hpp"

namespace handcast::renderer {
namespace {

using Parts = std::array<double, 3>;  ///< barycentric coordinates

std::uint8_t strongest_joint(const HandMesh& hand, const std::array<std::uint16_t, 3>& corners,
                             const Parts& part) {
  std::array<double, kJoints> weight{};
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 4; ++i)
      weight[hand.joints[corners[k]][i]] += part[k] * hand.weights[corners[k]][i];
  }
  return static_cast<std::uint8_t>(std::max_element(weight.begin(), weight.end()) - weight.begin());
}

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

}  // namespace

ChartMap::ChartMap(const HandMesh& hand, int width, int height) : texels_(width, height) {
  for (const auto& triangle : hand.triangles) draw_triangle(hand, triangle);
  std::array<double, 256> outwards{};
  for (std::size_t v = 0; v < hand.vertex_count(); ++v)
    outwards[hand.chart[v]] += hand.normals[v].y;
  for (std::size_t chart = 0; chart < outwards.size(); ++chart)
    facing_[chart] = outwards[chart] < 0 ? -1.f : 1.f;
  measure_edges();
}

void ChartMap::draw_triangle(const HandMesh& hand, const std::array<std::uint16_t, 3>& corners) {
  const glm::dvec2 size(texels_.width(), texels_.height());
  std::array<glm::dvec2, 3> at;  // in texels, whole numbers at texel centres
  for (int k = 0; k < 3; ++k) at[k] = glm::dvec2(hand.uv[corners[k]]) * size - 0.5;
  const double area = cross(at[1] - at[0], at[2] - at[0]);
  if (area == 0) return;
  const glm::dvec2 low = glm::min(at[0], glm::min(at[1], at[2])),
                   high = glm::max(at[0], glm::max(at[1], at[2]));
  const Rect box =
      Rect{static_cast<int>(std::ceil(low.x)), static_cast<int>(std::ceil(low.y)),
           static_cast<int>(std::floor(high.x)) + 1, static_cast<int>(std::floor(high.y)) + 1}
          .within(texels_.width(), texels_.height());
  constexpr double kSlack = 1e-9;  // texels on a shared edge may be drawn twice, but not missed
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const glm::dvec2 p(x, y);
      const Parts part{cross(at[2] - at[1], p - at[1]) / area,
                       cross(at[0] - at[2], p - at[2]) / area,
                       cross(at[1] - at[0], p - at[0]) / area};
      if (std::min({part[0], part[1], part[2]}) < -kSlack) continue;
      ChartTexel& texel = texels_.at(x, y);
      texel.chart = hand.chart[corners[0]];
      texel.joint = strongest_joint(hand, corners, part);
      texel.rest_mm = glm::vec3{0};
      for (int k = 0; k < 3; ++k)
        texel.rest_mm += 1000.f * static_cast<float>(part[k]) * hand.positions[corners[k]];
    }
  }
}

void ChartMap::measure_edges() {
  Image<std::uint8_t> on(texels_.width(), texels_.height()), off = on;
  for (int y = 0; y < on.height(); ++y) {
    for (int x = 0; x < on.width(); ++x) {
      const bool covered = texels_.at(x, y).chart != 0;
      on.at(x, y) = covered;
      off.at(x, y) = !covered;
      texels_.at(x, y).edge_px = cpu::NearestPixel::kLargestReach;
    }
  }
  cpu::NearestPixel nearest;
  for (const auto& way : nearest.find(std::as_const(off).view(), std::as_const(on).view(),
                                      cpu::NearestPixel::kLargestReach)) {
    texels_.at(way.x, way.y).edge_px = static_cast<std::uint8_t>(std::sqrt(way.squared_px));
  }
}

void ChartMap::pad(Image<glm::vec3>& colours) const {
  Image<std::uint8_t> on(texels_.width(), texels_.height()), off = on;
  for (int y = 0; y < on.height(); ++y) {
    for (int x = 0; x < on.width(); ++x) (texels_.at(x, y).chart != 0 ? on : off).at(x, y) = 1;
  }
  cpu::NearestPixel nearest;
  for (const auto& way : nearest.find(std::as_const(on).view(), std::as_const(off).view(),
                                      cpu::NearestPixel::kLargestReach)) {
    colours.at(way.x, way.y) = colours.at(way.x + way.dx, way.y + way.dy);
  }
}

}  // namespace handcast::renderer
