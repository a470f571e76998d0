// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/grey_surface.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/base/clones.hpp"

namespace handcast::twin {
namespace {

/// A value that is linear on the screen: `at_corner + x_step x + y_step y` from a corner.
struct Plane {
  float at_corner, x_step, y_step;
};

int first_pixel(float least) { return static_cast<int>(std::ceil(least - kBeyond_px)); }
int last_pixel(float most) { return static_cast<int>(std::floor(most + kBeyond_px)); }

/// The pixels of a row that a triangle may cover.
struct Row {
  float* __restrict depth;
  float* __restrict grey;
  float x, y;  ///< of the first pixel, from the corner
  int count;
};

/// Pixels are lanes of vectors: no branch depends on one. Those behind the row keep their values.
[[gnu::always_inline]] inline void draw_row(const Row& row, const Plane& b, const Plane& c,
                                            const Plane& depth, const Plane& grey) {
  const float b_at = b.at_corner + row.y * b.y_step, c_at = c.at_corner + row.y * c.y_step;
  const float depth_at = depth.at_corner + row.y * depth.y_step;
  const float grey_at = grey.at_corner + row.y * grey.y_step;
  const int lanes = (row.count + kSpare_px - 1) / kSpare_px * kSpare_px;
#pragma GCC ivdep
  for (int lane = 0; lane < lanes; ++lane) {
    const float x = row.x + static_cast<float>(lane);
    const float share_b = b_at + x * b.x_step, share_c = c_at + x * c.x_step;
    const float nearness = depth_at + x * depth.x_step;
    const float before = row.depth[lane];
    const bool drawn = (share_b >= kOutside) & (share_c >= kOutside) &
                       (1 - share_b - share_c >= kOutside) & (nearness > before) &
                       (lane < row.count);
    row.depth[lane] = drawn ? nearness : before;
    row.grey[lane] = drawn ? grey_at + x * grey.x_step : row.grey[lane];
  }
}

}  // namespace

HANDCAST_CLONES
void draw_grey(const ScreenVertices& v, std::span<const float> grey,
               std::span<const std::array<std::uint16_t, 3>> triangles, float front,
               const renderer::Rect& region, renderer::View<float> inverse_depth,
               renderer::View<float> image) {
  for (const auto& [i, j, k] : triangles) {
    const float ax = v.x[i], ay = v.y[i];
    const float bx = v.x[j] - ax, by = v.y[j] - ay, cx = v.x[k] - ax, cy = v.y[k] - ay;
    const float area = bx * cy - by * cx;
    if (area * front <= kFlat_px2) continue;
    if (!is_near_screen(ax, ay) || !is_near_screen(v.x[j], v.y[j]) ||
        !is_near_screen(v.x[k], v.y[k]))
      continue;
    const float scale = 1 / area;
    const Plane b{0, cy * scale, -cx * scale}, c{0, -by * scale, bx * scale};
    const auto between = [&](float at_a, float at_b, float at_c) {
      const float to_b = at_b - at_a, to_c = at_c - at_a;
      return Plane{at_a, to_b * b.x_step + to_c * c.x_step, to_b * b.y_step + to_c * c.y_step};
    };
    const Plane depth = between(v.inverse_depth[i], v.inverse_depth[j], v.inverse_depth[k]);
    const Plane shade = between(grey[i], grey[j], grey[k]);
    const renderer::Rect box = renderer::Rect{first_pixel(ax + std::min({0.0f, bx, cx})),
                                              first_pixel(ay + std::min({0.0f, by, cy})),
                                              last_pixel(ax + std::max({0.0f, bx, cx})) + 1,
                                              last_pixel(ay + std::max({0.0f, by, cy})) + 1}
                                   .overlap(region);
    for (int y = box.y0; y < box.y1; ++y)
      draw_row({inverse_depth.row(y) + box.x0, image.row(y) + box.x0,
                static_cast<float>(box.x0) - ax, static_cast<float>(y) - ay, box.width()},
               b, c, depth, shade);
  }
}

}  // namespace handcast::twin
