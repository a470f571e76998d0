// SPDX-License-Identifier: Apache-2.0
// Which place of the image each pixel of a crop shows, and how bright it is.
#include <gtest/gtest.h>

#include "services/landmarks/crop/crop.hpp"
#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

/// How much brighter than it should be a crop is, of a picture whose brightness changes by `slope`
/// a pixel along one axis.
float mean_excess(const Region& region, int axis, float slope) {
  constexpr int kSide = 96;
  const auto truth = [&](float at) { return 128 + slope * (at - 200); };
  const auto image = test::painted(
      400, 400, [&](int x, int y) { return truth(static_cast<float>(axis == 0 ? x : y)) + 0.5f; });
  Crop crop(kSide);
  crop.cut(image.view(), region);
  float sum = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const glm::vec2 at = region.to_image(
        (glm::vec2(i % kSide, i / kSide) + 0.5f) / static_cast<float>(kSide) - 0.5f);
    sum += crop.pixels()[i] - truth(at[axis]);
  }
  return sum / (kSide * kSide);
}

/// How far crops lie beside where they should, px of the image. (What rounding adds is the same up
/// and down the slope.)
float offset_px(const Region& region) {
  const auto along = [&](int axis) {
    return (mean_excess(region, axis, 0.6f) - mean_excess(region, axis, -0.6f)) / 1.2f;
  };
  return std::hypot(along(0), along(1));
}

TEST(Crop, PutsPixelMiddlesWhereTheyBelong) {
  EXPECT_LT(offset_px({{199.5f, 199.5f}, 96, 0}), 0.1f) << "as large as the picture";
  EXPECT_LT(offset_px({{200, 180}, 60, 0.6f}), 0.1f) << "enlarged and turned";
  EXPECT_LT(offset_px({{199.5f, 199.5f}, 192, 0}), 0.1f) << "half as large";
  EXPECT_LT(offset_px({{200, 190}, 200, 0.3f}), 0.1f) << "made smaller and turned";
  EXPECT_LT(offset_px({{199, 200}, 270, -0.2f}), 0.1f) << "a third as large and turned";
}

TEST(Crop, AWholeRegionIsTakenPixelByPixel) {
  const test::Grey image = test::noise(96, 96);
  Crop crop(96);
  crop.cut(image.view(), region_of_image(96, 96));
  EXPECT_TRUE(std::ranges::equal(crop.pixels(), image.pixels()));
}

TEST(Crop, FineStripesBecomeGreyAndNoMoire) {
  const auto image = test::painted(768, 768, [](int x, int) { return x % 2 ? 200 : 0; });
  Crop crop(192);
  crop.cut(image.view(), region_of_image(768, 768));
  for (const auto pixel : crop.pixels()) ASSERT_NEAR(pixel, 100, 1);
}

TEST(Crop, IsBlackBesideTheImage) {
  const test::Grey image(50, 40, 200);
  Crop crop(96);
  crop.cut(image.view(), {{0, 0}, 40, 0});
  EXPECT_EQ(crop.pixels()[0], 0);
  EXPECT_EQ(crop.pixels()[95 * 96 + 95], 200);
}

TEST(Crop, AHandHasTheSameBrightnessInDimAndInBrightLight) {
  const auto hand =
      test::painted(96, 96, [](int x, int y) { return std::hypot(x - 48, y - 48) < 30 ? 100 : 6; });
  const auto middle = [](const test::Grey& image) {
    Crop crop(96);
    crop.cut(image.view(), region_of_image(96, 96));
    std::vector<float> rgb(3 * 96 * 96);
    crop.write_rgb(rgb);
    return rgb[3 * (48 * 96 + 48) + 1];
  };
  const float expected = Crop::kHandLevel / 255;
  EXPECT_NEAR(middle(hand), expected, 0.01f);
  EXPECT_NEAR(middle(test::brightened(hand, 0.3)), expected, 0.02f);
  EXPECT_NEAR(middle(test::brightened(hand, 2.2)), expected, 0.01f);
}

TEST(Crop, ImagesWithoutPixelsAndRegionsThatAreNoneAreBlack) {
  Crop crop(96);
  for (const Region& region : {Region{{0, 0}, 0, 0},
                               {{1e9f, -1e9f}, 100, 1},
                               {{NAN, 5}, 100, 0},
                               {{5, 5}, INFINITY, 0},
                               {{5, 5}, 1e6f, 0}}) {
    crop.cut(test::Grey(0, 0).view(), region);
    EXPECT_EQ(std::ranges::count(crop.pixels(), 0), 96 * 96);
    crop.cut(test::Grey(3, 2, 0).view(), region);
    EXPECT_EQ(std::ranges::count(crop.pixels(), 0), 96 * 96);
  }
}

}  // namespace
}  // namespace handcast::landmarks
