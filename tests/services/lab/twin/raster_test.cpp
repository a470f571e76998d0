// SPDX-License-Identifier: Apache-2.0
// The rasters of the twin: at corners far outside the image, and the one with grey values beside
// the general one.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "services/lab/twin/grey_surface.hpp"
#include "services/lab/twin/surface.hpp"

namespace handcast::twin {
namespace {

constexpr int kRasterWidth = 64, kRasterHeight = 48;

/// Draws one triangle, and expects that only pixels of the image are painted. Returns how many.
int paint(const std::array<glm::vec2, 3>& corners) {
  ScreenVertices screen;
  screen.resize(3);
  for (std::size_t v = 0; v < 3; ++v) {
    screen.x[v] = corners[v].x;
    screen.y[v] = corners[v].y;
    screen.inverse_depth[v] = 1;
  }
  renderer::Image<float> depth(kRasterWidth, kRasterHeight);
  int count = 0;
  for (const float front : {1.0f, -1.0f})
    draw_triangle(screen, {0, 1, 2}, front, {0, 0, kRasterWidth, kRasterHeight}, depth.view(),
                  [&](int x, int y, float, float, float) {
                    EXPECT_TRUE(x >= 0 && x < kRasterWidth && y >= 0 && y < kRasterHeight)
                        << x << ", " << y;
                    ++count;
                  });
  return count;
}

TEST(Raster, PaintsTheWholeImageForATriangleAroundIt) {
  EXPECT_EQ(paint({glm::vec2{-500, -500}, {1000, -500}, {-500, 1000}}),
            kRasterWidth * kRasterHeight);
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

/// A surface of random triangles, each up to `size_px` wide, in and around the image.
struct Scene {
  Scene(int count, float size_px, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> x(-20, kRasterWidth + 20.0f),
        y(-20, kRasterHeight + 20.0f), aside(-size_px, size_px), unit(0.5f, 2);
    screen.resize(3 * static_cast<std::size_t>(count));
    for (std::size_t v = 0; v < screen.x.size(); ++v) {
      const bool first = v % 3 == 0;
      screen.x[v] = first ? x(random) : screen.x[v - v % 3] + aside(random);
      screen.y[v] = first ? y(random) : screen.y[v - v % 3] + aside(random);
      screen.inverse_depth[v] = unit(random);
      grey.push_back(100 * unit(random));
      if (first)
        triangles.push_back({static_cast<std::uint16_t>(v), static_cast<std::uint16_t>(v + 1),
                             static_cast<std::uint16_t>(v + 2)});
    }
  }
  ScreenVertices screen;
  std::vector<float> grey;
  std::vector<std::array<std::uint16_t, 3>> triangles;
};

// The triangles are drawn one after the other, so that a wrong depth shows, too.
TEST(Raster, GreyValuesAreThoseOfTheGeneralRasterInsideItsRegionAndUntouchedOutside) {
  const renderer::Rect region{5, 3, 61, 45};
  for (const float size_px : {1.3f, 3.0f, 40.0f, 300.0f}) {
    const Scene scene(4000, size_px, 7);
    renderer::Image<float> depth(kRasterWidth, kRasterHeight),
        expected(kRasterWidth, kRasterHeight);
    for (const auto& triangle : scene.triangles)
      draw_triangle(scene.screen, triangle, -1, region, depth.view(),
                    [&](int x, int y, float a, float b, float c) {
                      expected.at(x, y) = a * scene.grey[triangle[0]] +
                                          b * scene.grey[triangle[1]] + c * scene.grey[triangle[2]];
                    });
    renderer::Image<float> own_depth(kRasterWidth + kSpare_px, kRasterHeight),
        image(kRasterWidth + kSpare_px, kRasterHeight);
    for (int y = 0; y < kRasterHeight; ++y)
      for (int x = region.x1; x < kRasterWidth + kSpare_px; ++x) image.at(x, y) = -1;
    draw_grey(scene.screen, scene.grey, scene.triangles, -1, region, own_depth.view(),
              image.view());
    int drawn = 0, other = 0;
    for (int y = 0; y < kRasterHeight; ++y)
      for (int x = 0; x < kRasterWidth + kSpare_px; ++x) {
        if (x >= region.x1) {
          EXPECT_EQ(image.at(x, y), -1) << x << ", " << y;
          continue;
        }
        drawn += expected.at(x, y) != 0;
        // A pixel on an edge may be inside with one way to round and outside with the other.
        other += std::abs(image.at(x, y) - expected.at(x, y)) > 0.05f;
      }
    EXPECT_GT(drawn, 100) << size_px;
    EXPECT_LE(other, drawn / 500) << size_px;
  }
}

}  // namespace
}  // namespace handcast::twin
