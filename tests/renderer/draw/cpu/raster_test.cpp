// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/raster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace handcast::renderer::cpu {
namespace {

constexpr int kWidth = 96, kHeight = 80;
constexpr Rect kWhole{0, 0, kWidth, kHeight};

struct Sheet {
  std::vector<Corner> corners;
  std::vector<TriangleIndices> triangles;
  std::vector<std::int64_t> areas;
  std::vector<std::uint8_t> ids;

  TriangleList list(Facing facing) {
    facing_of(corners, triangles, areas);
    ids.assign(corners.size(), 1);
    static constexpr TexelMap kItself;
    return {corners, triangles, areas, ids, facing, {&kItself, 1}};
  }
};

/// A grid with nodes at random half or whole pixels, so its edges run through many pixel centres.
Sheet jittered_grid(unsigned seed) {
  std::mt19937 random(seed);
  const int coarse = seed % 2 == 0 ? 16 : 8, most = seed % 2 == 0 ? 1 : 3;
  std::uniform_int_distribution<int> step(-most, most);
  Sheet sheet;
  constexpr int kNodes = 12, kPitch = 8 * 16;
  for (int row = 0; row < kNodes; ++row) {
    for (int column = 0; column < kNodes; ++column) {
      sheet.corners.push_back({column * kPitch + step(random) * coarse,
                               row * kPitch + step(random) * coarse, 1, 0, 0, 255});
    }
  }
  for (int row = 0; row + 1 < kNodes; ++row) {
    for (int column = 0; column + 1 < kNodes; ++column) {
      const auto node = [&](int c, int r) {
        return static_cast<std::uint16_t>((row + r) * kNodes + column + c);
      };
      sheet.triangles.push_back({node(0, 0), node(1, 0), node(1, 1)});
      sheet.triangles.push_back({node(0, 0), node(1, 1), node(0, 1)});
    }
  }
  return sheet;
}

/// Draws band by band into a target of the whole image.
void draw(const TriangleList& list, RasterTarget& target, Rect region = kWhole) {
  TriangleBins bins;
  bins.sort(list, region);
  for (int band = region.y0 / kBand; band * kBand < region.y1; ++band)
    rasterise(list, bins.of_band(band),
              Rect{region.x0, band * kBand, region.x1, (band + 1) * kBand}.overlap(region), target);
}

TEST(Raster, EveryPixelOfASheetBelongsToExactlyOneTriangle) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Sheet sheet = jittered_grid(seed);
    std::vector<int> hits(kWidth * kHeight);
    const std::vector<TriangleIndices> all = sheet.triangles;
    for (const TriangleIndices& one : all) {
      sheet.triangles = {one};
      RasterTarget target(kWidth, kHeight);
      draw(sheet.list(Facing::both), target);
      for (int i = 0; i < kWidth * kHeight; ++i)
        hits[i] += std::isfinite(target.at(i % kWidth, i / kWidth).depth);
    }
    for (int y = 4; y < kHeight; ++y) {
      for (int x = 4; x < 80; ++x)
        ASSERT_EQ(hits[y * kWidth + x], 1) << "seed " << seed << " at " << x << ' ' << y;
    }
  }
}

TEST(Raster, TheSidesOfAClosedSurfaceAreToldApartWhicheverWayItIsWound) {
  // A tetrahedron with its near corner in the middle: three near faces.
  const std::vector<Corner> corners{{0, 0, 2}, {1600, 0, 2}, {800, 1600, 2}, {800, 600, 1}};
  const std::vector<TriangleIndices> near_is_positive{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
  std::vector<std::int64_t> areas;
  EXPECT_EQ(facing_of(corners, near_is_positive, areas), Facing::positive);
  std::vector<TriangleIndices> turned = near_is_positive;
  for (TriangleIndices& triangle : turned) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(facing_of(corners, turned, areas), Facing::negative);
  EXPECT_EQ(facing_of(corners, std::vector<TriangleIndices>{near_is_positive[0]}, areas),
            Facing::both);
}

TEST(Raster, OnlyTheAskedForSideIsDrawn) {
  Sheet sheet = jittered_grid(3);
  RasterTarget target(kWidth, kHeight);
  draw(sheet.list(Facing::negative), target);
  EXPECT_TRUE(std::isinf(target.at(40, 40).depth));
  draw(sheet.list(Facing::positive), target);
  EXPECT_TRUE(std::isfinite(target.at(40, 40).depth));
}

TEST(Raster, StartingForgetsEverythingDrawn) {
  Sheet sheet = jittered_grid(5);
  RasterTarget target(kWidth, kHeight);
  draw(sheet.list(Facing::both), target);
  target.start();
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      ASSERT_TRUE(std::isinf(target.at(x, y).depth)) << x << ' ' << y;
  }
}

TEST(Raster, OfEquallyNearTrianglesTheLaterIsSeen) {
  Sheet sheet;
  sheet.corners = {{0, 0, 1, 0, 0, 0}, {640, 0, 1, 0, 0, 0}, {0, 640, 1, 0, 0, 0},
                   {0, 0, 1, 1, 0, 0}, {640, 0, 1, 1, 0, 0}, {0, 640, 1, 1, 0, 0}};
  sheet.triangles = {{0, 1, 2}, {3, 4, 5}};
  RasterTarget target(kWidth, kHeight);
  draw(sheet.list(Facing::both), target);
  EXPECT_EQ(target.at(10, 10).s, 1);
}

/// What a list shows at a pixel, by the definition: the nearest of the triangles that cover it.
struct Shown {
  double depth = INFINITY, s = 0, t = 0, light = 0, second_depth = INFINITY;
  std::uint32_t id = 0;
};

Shown shown_at(const TriangleList& list, int x, int y) {
  Shown shown;
  for (const auto& triangle : list.triangles) {
    std::array corner{list.corners[triangle[0]], list.corners[triangle[1]],
                      list.corners[triangle[2]]};
    const auto cross = [](std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by) {
      return ax * by - ay * bx;
    };
    const std::int64_t area = cross(corner[1].x - corner[0].x, corner[1].y - corner[0].y,
                                    corner[2].x - corner[0].x, corner[2].y - corner[0].y);
    if (area == 0) continue;
    if (area < 0) std::swap(corner[1], corner[2]);
    std::array<double, 3> weight;  // by the corner opposite to an edge
    bool is_covered = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner &p = corner[(k + 1) % 3], &q = corner[(k + 2) % 3];
      const std::int32_t dx = q.x - p.x, dy = q.y - p.y;
      const std::int64_t inner = cross(dx, dy, 16 * x - p.x, 16 * y - p.y);
      const bool is_top_left = dy < 0 || (dy == 0 && dx > 0);
      is_covered &= inner > 0 || (inner == 0 && is_top_left);
      weight[k] = static_cast<double>(inner) / static_cast<double>(std::abs(area));
    }
    if (!is_covered) continue;
    const auto mean = [&](auto value) {
      return weight[0] * value(corner[0]) + weight[1] * value(corner[1]) +
             weight[2] * value(corner[2]);
    };
    const double depth = mean([](const Corner& c) { return c.depth; });
    shown.second_depth = std::min(shown.second_depth, std::max(depth, shown.depth));
    if (depth > shown.depth) continue;
    shown.depth = depth;
    shown.s = mean([](const Corner& c) { return c.u; });
    shown.t = mean([](const Corner& c) { return c.v; });
    shown.light = mean([](const Corner& c) { return c.light; });
    shown.id = list.ids[triangle[0]];
  }
  return shown;
}

/// Triangles of all sizes, from a part of a pixel to some that reach beyond the image.
Sheet loose_triangles(unsigned seed, float most_px) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> x(-20, kWidth + 20), y(-20, kHeight + 20),
      aside(-most_px, most_px), unit(0, 1);
  Sheet sheet;
  for (std::uint16_t i = 0; i < 60; ++i) {
    const float middle_x = x(random), middle_y = y(random);
    for (int k = 0; k < 3; ++k)
      sheet.corners.push_back({snapped(middle_x + aside(random)), snapped(middle_y + aside(random)),
                               unit(random), unit(random), unit(random), 255 * unit(random)});
    const auto first = static_cast<std::uint16_t>(3 * i);
    sheet.triangles.push_back(
        {first, static_cast<std::uint16_t>(first + 1), static_cast<std::uint16_t>(first + 2)});
  }
  return sheet;
}

TEST(Raster, DrawsWhatIsDrawnPixelByPixel) {
  constexpr Rect kRegion{5, 3, 93, 71};
  constexpr double kNear = 2e-4;  // slivers are steep
  int compared = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    Sheet sheet = loose_triangles(seed, std::array{1.f, 6.f, 25.f, 150.f}[seed % 4]);
    TriangleList list = sheet.list(Facing::both);
    for (std::size_t i = 0; i < sheet.ids.size(); ++i)
      sheet.ids[i] = static_cast<std::uint8_t>(1 + i / 3 % 60);
    RasterTarget target(kWidth, kHeight);
    draw(list, target, kRegion);
    for (int y = kRegion.y0; y < kRegion.y1; ++y) {
      for (int x = kRegion.x0; x < kRegion.x1; ++x) {
        const Shown shown = shown_at(list, x, y);
        const auto pixel = target.at(x, y);
        ASSERT_EQ(id_of_tag(pixel.tag) != 0, shown.id != 0) << seed << ": " << x << ' ' << y;
        if (shown.id == 0 || shown.second_depth - shown.depth < 2 * kNear) continue;
        ++compared;
        ASSERT_EQ(id_of_tag(pixel.tag), shown.id) << seed << ": " << x << ' ' << y;
        ASSERT_NEAR(pixel.depth, shown.depth, kNear) << seed << ": " << x << ' ' << y;
        ASSERT_NEAR(pixel.s, shown.s, kNear) << seed << ": " << x << ' ' << y;
        ASSERT_NEAR(pixel.t, shown.t, kNear) << seed << ": " << x << ' ' << y;
        ASSERT_NEAR(light_of(shade_of_tag(pixel.tag)), shown.light, 0.5 + 255 * kNear)
            << seed << ": " << x << ' ' << y;
      }
    }
  }
  EXPECT_GT(compared, 50'000);
}

/// Rounding takes the planes of the values out of their range in triangles like these.
TEST(Raster, TheValuesOfASliverStayInTheirRange) {
  constexpr Rect kScreen{0, 0, 1920, 1080};
  RasterTarget target(kScreen.x1, kScreen.y1);
  Sheet sheet;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> x(0, 16 * 1919), y(0, 16 * 1079), aside(-64, 64);
  int drawn = 0;
  for (int i = 0; i < 300; ++i) {
    const Corner a{x(random), y(random), 1, 0, 0, 0}, b{x(random), y(random), 1, 0, 0, 0},
        c{a.x + 2 * aside(random), a.y + aside(random), 1, 1, 1, 255};
    sheet.corners = {a, b, c};
    sheet.triangles = {{0, 1, 2}};
    const TriangleList list = sheet.list(Facing::both);
    target.start();
    draw(list, target, kScreen);
    for (int row = 0; row < kScreen.y1; ++row) {
      const Span columns = target.drawn(row / kBlockSide);
      for (int column = columns.x0 * kBlockSide;
           column < std::min(columns.x1 * kBlockSide, kScreen.x1); ++column) {
        const auto pixel = target.at(column, row);
        if (std::isinf(pixel.depth)) continue;
        ++drawn;
        ASSERT_EQ(level_of(shade_of_tag(pixel.tag)), 0) << i;
        ASSERT_EQ(id_of_tag(pixel.tag), 1u) << i;
        ASSERT_GE(pixel.s, -0.01f) << i;
        ASSERT_LE(pixel.s, 1.01f) << i;
      }
    }
  }
  EXPECT_GT(drawn, 1000);
}

}  // namespace
}  // namespace handcast::renderer::cpu
