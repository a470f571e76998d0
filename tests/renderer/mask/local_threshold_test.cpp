// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/local_threshold.hpp"

#include <gtest/gtest.h>

namespace handcast::renderer {
namespace {

constexpr Rect kAll{0, 0, 320, 160};

/// A hand of two bright halves, 160 and 60, on a ground of 8; both begin at row 80.
Image<std::uint8_t> uneven_hand() {
  Image<std::uint8_t> image(320, 160, 8);
  for (int y = 80; y < 160; ++y)
    for (int x = 0; x < 320; ++x) image.at(x, y) = x < 160 ? 160 : 60;
  return image;
}

TEST(LocalThreshold, ItFollowsTheLightAlongTheOutline) {
  const auto image = uneven_hand();
  LocalThreshold local;
  local.measure(image.view(), kAll, 45);
  EXPECT_NEAR(local.row(80, 40)[0], 8 + 0.35 * (160 - 8), 4);
  EXPECT_NEAR(local.row(80, 0)[280], 8 + 0.35 * (60 - 8), 5);
  EXPECT_EQ(local.row(80, 0)[280], local.row(80, 280)[0]) << "the first entry is that of x0";
}

TEST(LocalThreshold, ItChangesGraduallyBetweenCells) {
  const auto image = uneven_hand();
  LocalThreshold local;
  local.measure(image.view(), kAll, 45);
  const std::uint8_t* row = local.row(80, 0);
  for (int x = 1; x < 320; ++x) EXPECT_LE(std::abs(row[x] - row[x - 1]), 3) << x;
}

TEST(LocalThreshold, APixelHasTheThresholdOfItsRow) {
  const auto image = uneven_hand();
  LocalThreshold local;
  local.measure(image.view(), {3, 5, 317, 155}, 45);
  for (int y = 5; y < 155; y += 3)
    for (int x = 3; x < 317; ++x)
      ASSERT_EQ(local.row(y, x)[0], static_cast<int>(local.at(x, y))) << x << ' ' << y;
}

TEST(LocalThreshold, WithPixelsOnOneSideOnlyTheGlobalOneHolds) {
  const Image<std::uint8_t> dark(320, 160, 8);
  LocalThreshold local;
  local.measure(dark.view(), kAll, 45);
  for (const int x : {0, 100, 319}) EXPECT_EQ(local.row(10, 0)[x], 45);
}

TEST(LocalThreshold, ARegionAtTheEdgeOfTheImageIsReadInside) {
  auto image = uneven_hand();
  LocalThreshold local;
  local.measure(image.view(), {301, 93, 320, 160}, 45);  // 19 x 67: parts of cells
  for (int y = 93; y < 160; ++y) EXPECT_GT(local.row(y, 319)[0], 0) << y;
}

}  // namespace
}  // namespace handcast::renderer
