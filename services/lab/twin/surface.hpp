// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

/// Geometry of the true hand, shared by the camera and the judge.
namespace handcast::twin {

/// A bare forearm and a sleeve behind a hand, whose mesh ends in a short stub. Wrist axes, metres.
struct Forearm {
  std::vector<glm::vec3> positions;                     ///< by vertex
  std::vector<glm::vec3> normals;                       ///< by vertex
  std::vector<float> brightness;                        ///< by vertex, relative to skin
  std::vector<std::array<std::uint16_t, 3>> triangles;  ///< counter-clockwise seen from outside
};
/// Makes a forearm that fits the stub of `hand`. The sleeve begins at `sleeve_m` behind the wrist;
/// with kBareArm_m there is none.
Forearm make_forearm(const renderer::HandMesh& hand, float sleeve_m);
/// A start of the sleeve beyond the elbow.
inline constexpr float kBareArm_m = 1;

/// Distance of each vertex behind the wrist in the rest pose, metres; negative in the hand.
std::vector<float> behind_wrist_m(const renderer::HandMesh& hand);

/// The finger (0 thumb .. 4 little) of each vertex by its strongest joint; -1: palm, wrist or arm.
std::vector<int> fingers_of(const renderer::HandMesh& hand);

/// Vertices on a screen.
struct ScreenVertices {
  std::vector<float> x;              ///< px
  std::vector<float> y;              ///< px
  std::vector<float> inverse_depth;  ///< 1/m, which is linear on the screen

  /// Resizes all three.
  void resize(std::size_t count) {
    x.resize(count);
    y.resize(count);
    inverse_depth.resize(count);
  }
  /// The smallest rectangle of pixels that holds all vertices; not clipped to the screen.
  renderer::Rect bounds() const;
};

/// Barycentric coordinates of a point on the screen in a triangle; they sum to 1.
inline glm::vec3 barycentrics(const ScreenVertices& v, const std::array<std::uint16_t, 3>& triangle,
                              float x_px, float y_px) {
  const auto [i, j, k] = triangle;
  const float bx = v.x[j] - v.x[i], by = v.y[j] - v.y[i], cx = v.x[k] - v.x[i],
              cy = v.y[k] - v.y[i];
  const float px = x_px - v.x[i], py = y_px - v.y[i];
  const float area = bx * cy - by * cx;
  const float b = (px * cy - py * cx) / area, c = (bx * py - by * px) / area;
  return {1 - b - c, b, c};
}

/// The least barycentric coordinate of a pixel in a triangle: it leaves no gap between adjacent
/// ones.
inline constexpr float kOutside = -1e-5f;
/// Twice the area up to which a triangle is not drawn, square pixels.
inline constexpr float kFlat_px2 = 1e-9f;
/// By how much a triangle's pixels may lie outside its corners, px.
inline constexpr float kBeyond_px = 1e-3f;

/// One barycentric coordinate along a row of pixels: `at0 + step x`.
struct EdgeRow {
  float at0;   ///< value at x = 0
  float step;  ///< increment per pixel

  /// Reduces [first, last] to the pixels at which the coordinate is not negative.
  void cut(float& first, float& last) const {
    const float margin = at0 - kOutside;
    if (step > 0) {
      first = std::max(first, -margin / step);
    } else if (step < 0) {
      last = std::min(last, -margin / step);
    } else if (margin < 0) {
      last = first - 1;
    }
  }
};

/// True for a point whose coordinates a float resolves to a fraction of a pixel. A vertex near the
/// plane of the camera projects far beyond that.
inline bool is_near_screen(float x_px, float y_px) {
  constexpr float kFarthest_px = 1e5f;
  return std::abs(x_px) < kFarthest_px && std::abs(y_px) < kFarthest_px;
}

/// Draws one triangle with a depth test (`inverse_depth`: larger is nearer, 0 is empty) and calls
/// `paint(x, y, a, b, c)` with the pixel's barycentrics for each pixel whose centre is inside.
/// `front` is the sign of the area of triangles that face the viewer. A triangle with a corner that
/// is not near the screen is left out.
template <class Paint>
void draw_triangle(const ScreenVertices& v, const std::array<std::uint16_t, 3>& triangle,
                   float front, const renderer::Rect& clip, renderer::View<float> inverse_depth,
                   Paint&& paint) {
  const auto [i, j, k] = triangle;
  for (const auto corner : triangle)
    if (!is_near_screen(v.x[corner], v.y[corner])) return;
  const float ax = v.x[i], ay = v.y[i];
  const float bx = v.x[j] - ax, by = v.y[j] - ay, cx = v.x[k] - ax, cy = v.y[k] - ay;
  const float area = bx * cy - by * cx;
  if (area * front <= kFlat_px2) return;
  const int y0 = std::max(clip.y0, static_cast<int>(std::ceil(ay + std::min({0.0f, by, cy}))));
  const int y1 = std::min(clip.y1 - 1, static_cast<int>(std::floor(ay + std::max({0.0f, by, cy}))));
  const float left =
      std::max(static_cast<float>(clip.x0), ax + std::min({0.0f, bx, cx}) - kBeyond_px);
  const float right =
      std::min(static_cast<float>(clip.x1 - 1), ax + std::max({0.0f, bx, cx}) + kBeyond_px);
  const float scale = 1 / area;
  const float b_step = cy * scale, c_step = -by * scale;
  const float depth_a = v.inverse_depth[i], depth_b = v.inverse_depth[j] - depth_a,
              depth_c = v.inverse_depth[k] - depth_a;
  for (int y = y0; y <= y1; ++y) {
    const float py = static_cast<float>(y) - ay;
    const EdgeRow b{-py * cx * scale, b_step}, c{py * bx * scale, c_step},
        a{1 - b.at0 - c.at0, -b_step - c_step};
    float first = left - ax, last = right - ax;
    for (const EdgeRow& edge : {a, b, c}) edge.cut(first, last);
    float* depth_row = inverse_depth.row(y);
    // Clipped again: adding ax may have rounded outwards.
    const int x0 = std::max(clip.x0, static_cast<int>(std::ceil(first + ax)));
    const int x1 = std::min(clip.x1 - 1, static_cast<int>(std::floor(last + ax)));
    for (int x = x0; x <= x1; ++x) {
      const float px = static_cast<float>(x) - ax;
      const float share_b = b.at0 + px * b_step, share_c = c.at0 + px * c_step;
      const float nearness = depth_a + share_b * depth_b + share_c * depth_c;
      if (nearness <= depth_row[x]) continue;
      depth_row[x] = nearness;
      paint(x, y, 1 - share_b - share_c, share_b, share_c);
    }
  }
}

}  // namespace handcast::twin
