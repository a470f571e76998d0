// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "renderer/draw/painter.hpp"

namespace handcast::renderer::test {

/// A drawn hand made of loose triangles or sheets, in projector px.
class Shape {
 public:
  explicit Shape(Texture texture = ramp_texture(), bool smooth = false)
      : texture_(std::move(texture)), chain_(texture_, smooth) {}

  /// Red grows with u and green with v, so each texel is unique.
  static Texture ramp_texture() {
    Texture texture(256, 256);
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 256; ++x)
        texture.at(x, y) = 0xff000000u | 0x400000u | static_cast<std::uint32_t>(y << 8 | x);
    }
    return texture;
  }

  int vertex(glm::vec2 px, glm::vec2 uv, float depth_m = 1, std::uint8_t chart = 1,
             float light = 1) {
    position_px_.push_back(px);
    depth_m_.push_back(depth_m);
    light_.push_back(light);
    mesh_.positions.emplace_back(px, depth_m);
    mesh_.uv.push_back(uv);
    mesh_.chart.push_back(chart);
    return static_cast<int>(position_px_.size()) - 1;
  }
  void triangle(int a, int b, int c) {
    mesh_.triangles.push_back({static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b),
                               static_cast<std::uint16_t>(c)});
  }

  /// A rectangle with uv = position / 256 * `uv_scale` + `uv_offset`.
  void rectangle(glm::vec2 low, glm::vec2 high, float depth_m = 1, std::uint8_t chart = 1,
                 glm::vec2 uv_offset = {0, 0}, float uv_scale = 1) {
    const auto uv = [&](glm::vec2 px) { return px * uv_scale / 256.f + uv_offset; };
    const glm::vec2 right{high.x, low.y}, left{low.x, high.y};
    const int a = vertex(low, uv(low), depth_m, chart),
              b = vertex(right, uv(right), depth_m, chart),
              c = vertex(high, uv(high), depth_m, chart),
              d = vertex(left, uv(left), depth_m, chart);
    triangle(a, b, c);
    triangle(a, c, d);
  }

  void dim(float light) { std::fill(light_.begin(), light_.end(), light); }
  DrawnHand drawn(bool shaded = false) const {
    return {&mesh_, chain_.view(), position_px_, depth_m_,
            shaded ? std::span<const float>(light_) : std::span<const float>()};
  }
  const HandMesh& mesh() const { return mesh_; }
  const Texture& texture() const { return texture_; }
  const std::vector<glm::vec2>& position_px() const { return position_px_; }
  const std::vector<float>& depth_m() const { return depth_m_; }

 private:
  HandMesh mesh_;
  Texture texture_;
  MipChain chain_;
  std::vector<glm::vec2> position_px_;
  std::vector<float> depth_m_, light_;
};

inline void draw(Painter& painter, const Shape& shape, Rect region) {
  const DrawnHand drawn = shape.drawn();
  painter.draw({&drawn, 1}, region);
}

inline Image<std::uint8_t> mask_of(int width, int height, Rect set) {
  Image<std::uint8_t> mask(width, height);
  const Rect inside = set.within(width, height);
  for (int y = inside.y0; y < inside.y1; ++y) {
    for (int x = inside.x0; x < inside.x1; ++x) mask.at(x, y) = 255;
  }
  return mask;
}

inline std::uint32_t texel_at(const Texture& texture, glm::vec2 uv) {
  const int x =
      std::clamp(static_cast<int>(std::floor(uv.x * texture.width())), 0, texture.width() - 1);
  const int y =
      std::clamp(static_cast<int>(std::floor(uv.y * texture.height())), 0, texture.height() - 1);
  return texture.at(x, y);
}

/// What a pixel of a shape should show, computed in double precision.
struct Seen {
  glm::dvec2 uv{};
  double depth_m = 0;
  SurfaceId surface = 0;
  double margin_px = 0;  ///< distance of the pixel from the nearest edge, inwards
};

/// All triangles that cover a pixel or miss it by less than `slack_px`; not sorted.
inline std::vector<Seen> seen_at(const Shape& shape, int x, int y, double slack_px = 0,
                                 int hand = 0) {
  std::vector<Seen> all;
  const HandMesh& mesh = shape.mesh();
  const glm::dvec2 p(x, y);
  const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
  for (const auto& t : mesh.triangles) {
    const glm::dvec2 a = shape.position_px()[t[0]], b = shape.position_px()[t[1]],
                     c = shape.position_px()[t[2]];
    const double area = cross(b - a, c - a);
    if (area == 0) continue;
    const double wa = cross(c - b, p - b) / area, wb = cross(a - c, p - c) / area, wc = 1 - wa - wb;
    const double margin =
        std::abs(area) *
        std::min({wa / glm::length(c - b), wb / glm::length(a - c), wc / glm::length(b - a)});
    if (margin < -slack_px) continue;
    const auto mix = [&](auto of) { return wa * of(t[0]) + wb * of(t[1]) + wc * of(t[2]); };
    all.push_back({mix([&](int i) { return glm::dvec2(mesh.uv[i]); }),
                   mix([&](int i) { return double{shape.depth_m()[i]}; }),
                   surface_id(hand, mesh.chart[t[0]]), margin});
  }
  return all;
}

}  // namespace handcast::renderer::test
