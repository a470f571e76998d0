// SPDX-License-Identifier: Apache-2.0
// Where the networks are shown the image, and what they are shown of it.
#include <gtest/gtest.h>

#include <numbers>

#include "services/landmarks/finder/crop.hpp"
#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

glm::vec2 turned(glm::vec2 v, float angle_rad) {
  return {std::cos(angle_rad) * v.x - std::sin(angle_rad) * v.y,
          std::sin(angle_rad) * v.x + std::cos(angle_rad) * v.y};
}

/// An open hand, fingers up, its wrist at (0, 0), its palm `palm_px` long.
Points open_hand(float palm_px) {
  Points points{};
  for (int finger = 0; finger < 5; ++finger)
    for (int k = 0; k < 4; ++k)
      points[1 + 4 * finger + k] = palm_px * glm::vec2(0.25f * static_cast<float>(2 - finger),
                                                       -1.0f - 0.3f * static_cast<float>(k));
  return points;
}

Points placed(Points points, glm::vec2 at_px, float angle_rad) {
  for (auto& point : points) point = at_px + turned(point, angle_rad);
  return points;
}

TEST(Region, AHandThatPointsUpIsNotTurned) {
  EXPECT_NEAR(region_of_landmarks(placed(open_hand(100), {300, 400}, 0)).angle_rad, 0, 1e-4);
}

TEST(Region, TurnsAndMovesWithTheHand) {
  const Region upright = region_of_landmarks(placed(open_hand(100), {300, 400}, 0));
  for (const float angle_rad : {0.4f, -1.2f, kPi / 2, 3.0f}) {
    const Region region = region_of_landmarks(placed(open_hand(100), {300, 400}, angle_rad));
    EXPECT_NEAR(std::remainder(region.angle_rad - angle_rad, 2 * kPi), 0, 1e-4);
    EXPECT_NEAR(region.size_px, upright.size_px, 0.01);
    const glm::vec2 expected =
        glm::vec2(300, 400) + turned(upright.centre_px - glm::vec2(300, 400), angle_rad);
    EXPECT_NEAR(glm::distance(region.centre_px, expected), 0, 0.02);
  }
}

TEST(Region, HoldsTheWholeHandUpright) {
  const Points points = placed(open_hand(120), {500, 380}, 2.2f);
  const Region region = region_of_landmarks(points);
  for (const auto& point : points) {
    const glm::vec2 place = region.to_place(point);
    EXPECT_LT(std::max(std::abs(place.x), std::abs(place.y)), 0.5f);
  }
  EXPECT_LT(region.to_place(points[12]).y, region.to_place(points[0]).y)
      << "the fingers are above the wrist";
}

TEST(Region, PlacesAndPixelsAreInverse) {
  const Region region{{310, 222}, 187, 0.7f};
  const glm::vec2 place(0.31f, -0.22f);
  EXPECT_NEAR(glm::distance(region.to_place(region.to_image(place)), place), 0, 1e-5);
}

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
