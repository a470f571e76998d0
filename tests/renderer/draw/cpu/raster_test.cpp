// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/raster.hpp"

#include <gtest/gtest.h>

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
void draw(const TriangleList& list, RasterTarget& target) {
  TriangleBins bins;
  bins.sort(list, kWhole);
  for (int band = 0; band * kBand < kHeight; ++band)
    rasterise(list, bins.of_band(band),
              Rect{0, band * kBand, kWidth, (band + 1) * kBand}.overlap(kWhole), target);
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
    const std::vector<std::uint32_t> first{0};
    target.start();
    rasterise(list, first, kScreen, target);
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
