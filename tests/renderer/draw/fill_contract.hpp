// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/renderer/draw/painter_contract.hpp"

/// The contract of Painter::fill().
namespace handcast::renderer::test {

TEST_P(PainterContract, WithoutAHandInTheMaskEverythingIsDark) {
  Shape shape;
  shape.rectangle({20, 20}, {120, 100});
  draw(*painter_, shape, kWhole);
  const FillCounts counts = fill(mask_of(kWidth, kHeight, {}));
  EXPECT_EQ(lit_pixels(), 0);
  expect_consistent();
  EXPECT_EQ(counts.lit + counts.filled + counts.dark, 0);
}

TEST_P(PainterContract, WithoutADrawingThereIsNothingToFillFrom) {
  painter_->draw({}, kWhole);
  const FillCounts counts = fill(mask_of(kWidth, kHeight, {10, 10, 60, 60}));
  EXPECT_EQ(lit_pixels(), 0);
  EXPECT_EQ(counts.dark, 50 * 50);
}

TEST_P(PainterContract, AHandThatIsLitAlreadyStaysAsItIs) {
  Shape shape;
  shape.rectangle({19.5f, 19.5f}, {119.5f, 99.5f});
  draw(*painter_, shape, kWhole);
  const std::uint32_t before = colour(70, 60);
  const FillCounts counts = fill(mask_of(kWidth, kHeight, {20, 20, 120, 100}));
  EXPECT_EQ(counts.lit, 100 * 80);
  EXPECT_EQ(counts.filled, 0);
  EXPECT_EQ(colour(70, 60), before);
  EXPECT_EQ(lit_pixels(), 100 * 80);
}

TEST_P(PainterContract, AfterTheFillThereIsLightOnTheHandOnlyAndAllOverIt) {
  Shape shape;
  shape.rectangle({19.5f, 19.5f}, {119.5f, 99.5f});
  draw(*painter_, shape, kWhole);
  const Image<std::uint8_t> mask = mask_of(kWidth, kHeight, {32, 25, 132, 105});
  const FillCounts counts = fill(mask);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      ASSERT_EQ(surface(x, y) != 0, mask.at(x, y) != 0) << x << ' ' << y;
  }
  expect_consistent();
  EXPECT_EQ(counts.lit, 88 * 75);
  EXPECT_EQ(counts.filled, 100 * 80 - 88 * 75);
  EXPECT_EQ(counts.dark, 0);
}

TEST_P(PainterContract, APixelThatIsHandInPartGetsThisPartOfItsLight) {
  Shape shape(Texture(1, 1, 0xffc8c8c8), true);
  shape.rectangle({20, 20}, {60, 60});
  draw(*painter_, shape, kWhole);
  Image<std::uint8_t> mask = mask_of(kWidth, kHeight, {20, 20, 70, 61});
  mask.at(40, 30) = 64;  // drawn
  mask.at(65, 30) = 64;  // filled
  fill(mask);
  EXPECT_EQ(colour(41, 30), 0xffc8c8c8u);
  EXPECT_EQ(colour(64, 30), 0xffc8c8c8u);
  for (const int x : {40, 65}) {
    EXPECT_EQ(alpha(x, 30), 64u) << x;
    // A quarter of the light of sRGB 200 is sRGB 106; the factor 137 / 256 of the level is near.
    EXPECT_NEAR(static_cast<int>(colour(x, 30) & 0xff), 107, 1) << x;
  }
}

TEST_P(PainterContract, TheFillContinuesALinearTextureExactly) {
  Shape shape;
  shape.rectangle({19.5f, 19.5f}, {119.5f, 99.5f});
  draw(*painter_, shape, kWhole);
  fill(mask_of(kWidth, kHeight, {32, 25, 140, 112}));
  for (int y = 25; y < 112; ++y) {
    for (int x = 32; x < 140; ++x) {
      ASSERT_NEAR(uv(x, y).x, x / 256.f, 2e-5) << x << ' ' << y;
      ASSERT_NEAR(uv(x, y).y, y / 256.f, 2e-5) << x << ' ' << y;
      ASSERT_EQ(colour(x, y), texel_at(shape.texture(), uv(x, y))) << x << ' ' << y;
    }
  }
}

TEST_P(PainterContract, AtTheSeamBetweenTwoChartsTheFillKeepsTheSeedsOwnColour) {
  // A narrow strip of chart 2 to the right of chart 1: far pixels are reflected onto chart 1,
  // although the texture coordinates are continuous.
  Shape shape;
  shape.rectangle({19.5f, 19.5f}, {99.5f, 99.5f}, 1, 1);
  shape.rectangle({99.5f, 19.5f}, {104.5f, 99.5f}, 1, 2);
  draw(*painter_, shape, kWhole);
  fill(mask_of(kWidth, kHeight, {20, 20, 124, 100}));
  const float own = 104 / 256.f;
  for (int x = 105; x < 124; ++x) {
    EXPECT_EQ(surface(x, 60), 2) << x;
    const bool within_strip = 2 * 104 - x >= 100;
    EXPECT_NEAR(uv(x, 60).x, within_strip ? x / 256.f : own, 2e-5) << x;
  }
}

TEST_P(PainterContract, AJumpInTheTextureOfOneChartIsASeamToo) {
  Shape shape;
  shape.rectangle({19.5f, 19.5f}, {99.5f, 99.5f}, 1, 1);
  shape.rectangle({99.5f, 19.5f}, {104.5f, 99.5f}, 1, 1, {0.3f, 0});
  draw(*painter_, shape, kWhole);
  fill(mask_of(kWidth, kHeight, {20, 20, 124, 100}));
  EXPECT_NEAR(uv(107, 60).x, 107 / 256.f + 0.3f, 2e-5);
  EXPECT_NEAR(uv(115, 60).x, 104 / 256.f + 0.3f, 2e-5);
}

TEST_P(PainterContract, BeyondTheReachItStaysDarkAndBeforeThatItFades) {
  Shape shape(Texture(1, 1, 0xffc8c8c8));
  shape.rectangle({-10, -10}, {49.5f, 160});
  draw(*painter_, shape, kWhole);
  settings_.reach_px = 20;
  settings_.fade_px = 8;
  const FillCounts counts = fill(mask_of(kWidth, kHeight, kWhole));
  const auto red = [&](int px_away) { return colour(49 + px_away, 70) & 0xff; };
  EXPECT_EQ(red(12), 0xc8u);
  for (int away = 13; away < 20; ++away) {
    EXPECT_LT(red(away), red(away - 1)) << away;
    const double level = red(away) / double{0xc8};
    EXPECT_NEAR(alpha(49 + away, 70), 255 * srgb_light(level), 4) << "its share of the light";
  }
  EXPECT_EQ(alpha(49 + 20, 70), 0u);
  EXPECT_EQ(surface(49 + 20, 70), 0);
  EXPECT_EQ(counts.lit, 50 * kHeight);
  EXPECT_EQ(counts.filled, 19 * kHeight);
  EXPECT_EQ(counts.dark, (kWidth - 50 - 19) * kHeight);
}

TEST_P(PainterContract, AFillCountsThePixelsOfItsRegionAlone) {
  Shape shape;
  shape.rectangle({-60, -60}, {kWidth + 60, kHeight + 60});
  const auto everywhere = mask_of(kWidth, kHeight, kWhole);
  for (const Rect region : {Rect{0, 0, 30, 9}, {5, 3, 31, 20}, {3, 0, kWidth, 5}, kWhole}) {
    draw(*painter_, shape, kWhole);
    const FillCounts counts = fill(everywhere, region);
    EXPECT_EQ(counts.lit, region.width() * region.height()) << region.x0 << ' ' << region.x1;
    EXPECT_EQ(counts.filled + counts.dark, 0);
  }
}

TEST_P(PainterContract, AHandAtTheImagesBorderIsFilledUpToIt) {
  Shape shape;
  shape.rectangle({-60, -60}, {9.5f, 9.5f});
  draw(*painter_, shape, kWhole);
  const FillCounts counts = fill(mask_of(kWidth, kHeight, {0, 0, 25, 25}));
  EXPECT_EQ(counts.lit, 100);
  EXPECT_EQ(counts.filled, 25 * 25 - 100);
  EXPECT_EQ(lit_pixels(), 25 * 25);
  // Without a reflection inside the image the seed's own texture coordinates are used: (20, 5) is
  // reflected at (9, 5) to (-2, 5).
  EXPECT_NEAR(uv(20, 5).x, 9 / 256.f, 2e-5);
  EXPECT_NEAR(uv(15, 5).x, 15 / 256.f, 2e-5);
}

TEST_P(PainterContract, ShadingGoesOnIntoTheFill) {
  Shape shape(Texture(1, 1, 0xffc8c8c8));
  shape.rectangle({10, 10}, {50, 50});
  shape.dim(0.5f);
  const DrawnHand shaded = shape.drawn(true);
  painter_->draw({&shaded, 1}, kWhole);
  fill(mask_of(kWidth, kHeight, {10, 10, 60, 50}));
  EXPECT_NEAR(colour(55, 30) & 0xff, colour(40, 30) & 0xff, 2);
}

TEST_P(PainterContract, FillingTouchesItsRegionOnly) {
  Shape shape;
  shape.rectangle({0, 0}, {199, 149});
  draw(*painter_, shape, kWhole);
  fill(mask_of(kWidth, kHeight, {}), {37, 29, 101, 90});
  EXPECT_EQ(lit_pixels({37, 29, 101, 90}), 0);
  EXPECT_EQ(lit_pixels({0, 0, 199, 149}), 199 * 149 - 64 * 61);
  expect_consistent();
}

TEST_P(PainterContract, MethodNoneLeavesTheDrawingAsItIs) {
  Shape shape;
  shape.rectangle({19.5f, 19.5f}, {119.5f, 99.5f});
  draw(*painter_, shape, kWhole);
  settings_.method = config::FillMethod::none;
  fill(mask_of(kWidth, kHeight, {}));
  EXPECT_EQ(lit_pixels(), 100 * 80);
}

}  // namespace handcast::renderer::test
