// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "tests/renderer/draw/painter_contract.hpp"

/// The contract of Painter::warp(), alone and between the other passes.
namespace handcast::renderer::test {

inline WarpGrid grid_of(int columns, int rows, Rect area,
                        const std::function<glm::vec2(glm::vec2)>& move) {
  WarpGrid grid{columns, rows, area, {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const glm::vec2 part{static_cast<float>(column) / (columns - 1),
                           static_cast<float>(row) / (rows - 1)};
      grid.nodes.push_back(move(glm::vec2{area.x0, area.y0} +
                                part * glm::vec2{area.width() - 1, area.height() - 1}));
    }
  }
  return grid;
}

TEST_P(PainterContract, TheGridAtRestMovesNothingAndLosesNothing) {
  Shape shape;
  shape.rectangle({-10, -10}, {300, 300});
  draw(*painter_, shape, kWhole);
  painter_->warp(grid_of(21, 21, kWhole, [](glm::vec2 p) { return p; }), kWhole, kWhole);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_EQ(surface(x, y), 1) << x << ' ' << y;
      ASSERT_NEAR(uv(x, y).x, x / 256.f, 1e-4) << x << ' ' << y;
      ASSERT_NEAR(uv(x, y).y, y / 256.f, 1e-4) << x << ' ' << y;
    }
  }
  expect_consistent();
}

TEST_P(PainterContract, AShiftedGridShiftsTheDrawing) {
  Shape shape;
  shape.rectangle({39.5f, 29.5f}, {89.5f, 69.5f});
  draw(*painter_, shape, kWhole);
  painter_->warp(grid_of(11, 9, kWhole,
                         [](glm::vec2 p) {
                           return p + glm::vec2{17, -6};
                         }),
                 kWhole, kWhole);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool inside = x >= 57 && x < 107 && y >= 24 && y < 64;
      ASSERT_EQ(surface(x, y) != 0, inside) << x << ' ' << y;
      if (!inside) continue;
      ASSERT_NEAR(uv(x, y).x, (x - 17) / 256.f, 1e-4);
      ASSERT_EQ(colour(x, y), texel_at(shape.texture(), uv(x, y)));
    }
  }
  expect_consistent();
}

TEST_P(PainterContract, AWarpTakesFromOneRegionAndLightsAnother) {
  Shape shape;
  shape.rectangle({-10, -10}, {300, 300});
  draw(*painter_, shape, kWhole);
  const Rect from{40, 30, 90, 70}, region{50, 20, 120, 60};
  painter_->warp(grid_of(11, 9, kWhole,
                         [](glm::vec2 p) {
                           return p + glm::vec2{17, -6};
                         }),
                 from, region);
  for (int y = region.y0; y < region.y1; ++y) {
    for (int x = region.x0; x < region.x1; ++x) {
      const bool inside = x >= 57 && x < 107 && y >= 24 && y < 64;
      ASSERT_EQ(surface(x, y) != 0, inside) << x << ' ' << y;
    }
  }
  expect_consistent(region);
}

TEST_P(PainterContract, WhereCellsOverlapTheLaterOneIsSeen) {
  Shape shape;
  shape.rectangle({-10, -10}, {300, 300});
  draw(*painter_, shape, kWhole);
  // Three columns of nodes: the right cells are folded back over the left ones.
  painter_->warp(grid_of(3, 3, kWhole,
                         [](glm::vec2 p) {
                           return p.x > 150 ? glm::vec2{0, p.y} : p;
                         }),
                 kWhole, kWhole);
  for (const int x : {20, 50, 80}) EXPECT_GT(uv(x, 60).x, 99 / 256.f) << x;
}

TEST_P(PainterContract, DrawWarpAndFillGoTogether) {
  Shape shape;
  shape.rectangle({39.5f, 29.5f}, {89.5f, 69.5f});
  for (int frame = 0; frame < 3; ++frame) {  // no frame may show remains of the one before
    draw(*painter_, shape, {20, 10, 150, 120});
    painter_->warp(grid_of(11, 9, kWhole,
                           [](glm::vec2 p) {
                             return p + glm::vec2{17, -6};
                           }),
                   {20, 10, 150, 120}, {20, 10, 150, 120});
    const FillCounts counts = fill(mask_of(kWidth, kHeight, {57, 24, 115, 70}), {20, 10, 150, 120});
    EXPECT_EQ(counts.lit, 50 * 40);
    EXPECT_EQ(counts.filled, 58 * 46 - 50 * 40);
    EXPECT_EQ(lit_pixels({20, 10, 150, 120}), 58 * 46);
    EXPECT_NEAR(uv(112, 40).x, (112 - 17) / 256.f, 1e-4);
    expect_consistent({20, 10, 150, 120});
  }
}

}  // namespace handcast::renderer::test
