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

/// Small tools shared by what looks at the true hand: the camera and the judge.
namespace handcast::twin {

/// A bare forearm and a sleeve behind a hand, in the wrist's axes (metres): the hand's mesh ends in
/// a short stub.
struct Forearm {
  std::vector<glm::vec3> positions, normals;
  std::vector<float> brightness;  ///< beside skin: 1
  std::vector<std::array<std::uint16_t, 3>> triangles;
};
/// Fits the stub of `hand`. The sleeve begins at `sleeve_m` behind the wrist; kBareArm_m: there is
/// none.
Forearm make_forearm(const renderer::HandMesh& hand, float sleeve_m);
inline constexpr float kBareArm_m = 1;

/// How far each vertex at rest lies behind the wrist, metres.
std::vector<float> behind_wrist_m(const renderer::HandMesh& hand);

/// Corners on a screen: px, and 1/depth (which is linear on the screen).
struct ScreenVertices {
  std::vector<float> x, y, inverse_depth;

  void resize(std::size_t count) {
    x.resize(count);
    y.resize(count);
    inverse_depth.resize(count);
  }
  renderer::Rect bounds() const;  ///< of all pixels they span, not clipped
};

/// Shares of a triangle's corners in a point of the screen; they sum to 1.
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

/// One barycentric along a row of pixels: `at0 + step x`. Cuts [first, last] down to where it is
/// not negative.
struct EdgeRow {
  float at0, step;

  void cut(float& first, float& last) const {
    constexpr float kOutside = -1e-5f;  // neighbours share their edge: no gaps
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

/// Draws one triangle with a depth test (`inverse_depth`: larger is nearer, 0 is empty) and calls
/// `paint(x, y, a, b, c)` with the pixel's barycentrics for each pixel whose centre is inside.
/// `front` is the sign of the area of triangles that face the viewer.
template <class Paint>
void draw_triangle(const ScreenVertices& v, const std::array<std::uint16_t, 3>& triangle,
                   float front, const renderer::Rect& clip, renderer::View<float> inverse_depth,
                   Paint&& paint) {
  const auto [i, j, k] = triangle;
  const float ax = v.x[i], ay = v.y[i];
  const float bx = v.x[j] - ax, by = v.y[j] - ay, cx = v.x[k] - ax, cy = v.y[k] - ay;
  const float area = bx * cy - by * cx;
  if (area * front <= 1e-9f) return;
  const int y0 = std::max(clip.y0, static_cast<int>(std::ceil(ay + std::min({0.0f, by, cy}))));
  const int y1 = std::min(clip.y1 - 1, static_cast<int>(std::floor(ay + std::max({0.0f, by, cy}))));
  const float left = std::max(static_cast<float>(clip.x0), ax + std::min({0.0f, bx, cx}) - 1e-3f);
  const float right =
      std::min(static_cast<float>(clip.x1 - 1), ax + std::max({0.0f, bx, cx}) + 1e-3f);
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
    const int x1 = static_cast<int>(std::floor(last + ax));
    for (int x = static_cast<int>(std::ceil(first + ax)); x <= x1; ++x) {
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
