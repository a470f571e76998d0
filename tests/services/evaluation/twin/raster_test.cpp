// SPDX-License-Identifier: Apache-2.0
// The raster of the twin at corners far outside its image.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "services/evaluation/twin/surface.hpp"

namespace handcast::twin {
namespace {

constexpr int kWidth = 64, kHeight = 48;

/// Draws one triangle, and expects that only pixels of the image are painted. Returns how many.
int paint(const std::array<glm::vec2, 3>& corners) {
  ScreenVertices screen;
  screen.resize(3);
  for (std::size_t v = 0; v < 3; ++v) {
    screen.x[v] = corners[v].x;
    screen.y[v] = corners[v].y;
    screen.inverse_depth[v] = 1;
  }
  renderer::Image<float> depth(kWidth, kHeight);
  int count = 0;
  for (const float front : {1.0f, -1.0f})
    draw_triangle(screen, {0, 1, 2}, front, {0, 0, kWidth, kHeight}, depth.view(),
                  [&](int x, int y, float, float, float) {
                    EXPECT_TRUE(x >= 0 && x < kWidth && y >= 0 && y < kHeight) << x << ", " << y;
                    ++count;
                  });
  return count;
}

TEST(Raster, PaintsTheWholeImageForATriangleAroundIt) {
  EXPECT_EQ(paint({glm::vec2{-500, -500}, {1000, -500}, {-500, 1000}}), kWidth * kHeight);
}

TEST(Raster, StaysInTheImageWhereverTheCornersAre) {
  std::mt19937 random(3);
  for (const float far : {1e2f, 1e3f, 1e4f, 9e4f, 1e6f, 1e9f, 1e20f, 3e38f}) {
    std::uniform_real_distribution<float> place(-far, far);
    for (int trial = 0; trial < 2000; ++trial)
      paint({glm::vec2{place(random), place(random)},
             {place(random), place(random)},
             {place(random), place(random)}});
  }
}

TEST(Raster, LeavesOutATriangleWithoutAPlace) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(paint({glm::vec2{nan, 0}, {50, 0}, {0, 40}}), 0);
  EXPECT_EQ(paint({glm::vec2{infinity, 0}, {50, 0}, {0, 40}}), 0);
}

}  // namespace
}  // namespace handcast::twin
