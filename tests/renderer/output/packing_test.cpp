// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/packing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "config/sections/sub_frames.hpp"
#include "renderer/output/light.hpp"
#include "tests/renderer/output/unpacked.hpp"

namespace handcast::renderer {
namespace {

using config::Packing;

constexpr int kWidth = 200, kHeight = 64;  ///< of output frames; no multiple of a vector
constexpr Rect kAll{0, 0, kWidth, kHeight};
constexpr std::uint32_t kOpaque = 0xff000000u, kWhite = 0xffffffffu;

std::uint32_t grey(int level) { return kOpaque | static_cast<std::uint32_t>(level) * 0x010101u; }

config::Projector settings(Packing packing, bool dither = true) {
  config::Projector projector;
  projector.packing = packing;
  projector.dither = dither;
  return projector;
}

Texture flat(std::uint32_t colour, int width = kWidth, int height = kHeight) {
  return {width, height, colour};
}

Texture many_colours(int width, int height) {
  Texture drawing(width, height);
  for (std::size_t i = 0; i < drawing.pixels().size(); ++i)
    drawing.pixels()[i] = static_cast<std::uint32_t>(i) * 2654435761u | kOpaque;
  return drawing;
}

std::vector<std::uint32_t> pixels_of(const Packer& packer) {
  const auto image = packer.image();
  return {image.data, image.data + static_cast<std::ptrdiff_t>(image.width) * image.height};
}

/// Share of the light of all planes of 24x1 if each drawing has one grey.
double light_of_planes(const config::Projector& projector, int level, double fade = 1) {
  const auto packer = make_packer(projector, kWidth, kHeight);
  packer->begin(fade);
  packer->add(flat(grey(level)).view(), kAll, 0, 24);
  int lit = 0;
  for (int k = 0; k < 24; ++k) {
    const auto plane = test::plane_of_24(packer->image(), k);
    lit += std::accumulate(plane.pixels().begin(), plane.pixels().end(), 0);
  }
  return lit / (24. * kWidth * kHeight);
}

TEST(BitPlanes, HaveTheLightOfEachGreyLevel) {
  const auto light = light_of_levels();
  for (int level = 0; level < 256; level += 3)
    EXPECT_NEAR(light_of_planes(settings(Packing::planes_24x1), level),
                light[static_cast<std::size_t>(level)], 0.003)
        << level;
}

TEST(BitPlanes, BlackIsNoLightAndWhiteIsAllPlanes) {
  for (const bool dither : {true, false}) {
    EXPECT_EQ(light_of_planes(settings(Packing::planes_24x1, dither), 0), 0);
    EXPECT_EQ(light_of_planes(settings(Packing::planes_24x1, dither), 255), 1);
  }
}

TEST(BitPlanes, BrightnessAndFadeAreSharesOfTheLight) {
  auto projector = settings(Packing::planes_24x1);
  projector.brightness = 0.5;
  for (const double gamma : {0., 1., 2.2}) {
    projector.gamma = gamma;  // bits have no levels that a gamma could change
    EXPECT_NEAR(light_of_planes(projector, 255), 0.5, 0.003);
    EXPECT_NEAR(light_of_planes(projector, 255, 0.5), 0.25, 0.003);
    EXPECT_EQ(light_of_planes(projector, 255, 0), 0);
  }
}

TEST(BitPlanes, WithoutDitherHalfOfTheLightIsWhiteAndBrightnessIsTheShareOfPlanes) {
  auto projector = settings(Packing::planes_24x1, false);
  EXPECT_EQ(light_of_planes(projector, 187), 0) << "0.497 of the light";
  EXPECT_EQ(light_of_planes(projector, 188), 1) << "0.503 of the light";
  projector.brightness = 0.25;
  EXPECT_EQ(light_of_planes(projector, 187), 0);
  EXPECT_EQ(light_of_planes(projector, 188), 0.25);
}

TEST(BitPlanes, EachPlaneIsItsOwnDrawing) {
  const auto packer = make_packer(settings(Packing::planes_24x1), kWidth, kHeight);
  packer->begin(1);
  for (int k = 0; k < 24; ++k) {
    auto drawing = flat(kOpaque);
    drawing.at(3 * k, 5) = kWhite;
    packer->add(drawing.view(), kAll, k, 1);
  }
  for (int k = 0; k < 24; ++k) {
    Image<int> expected(kWidth, kHeight);
    expected.at(3 * k, 5) = 1;
    EXPECT_EQ(test::plane_of_24(packer->image(), k).pixels(), expected.pixels()) << k;
  }
}

TEST(BitPlanes, AStillPixelHasItsLightToWithinOnePlane) {
  const auto packer = make_packer(settings(Packing::planes_24x1), kWidth, kHeight);
  const auto light = light_of_levels();
  for (const int level : {40, 100, 150, 200, 240}) {
    packer->begin(1);
    packer->add(flat(grey(level)).view(), kAll, 0, 24);
    Image<int> sum(kWidth, kHeight);
    for (int k = 0; k < 24; ++k) {
      const auto plane = test::plane_of_24(packer->image(), k);
      for (std::size_t i = 0; i < plane.pixels().size(); ++i) sum.pixels()[i] += plane.pixels()[i];
    }
    for (const int planes : sum.pixels())
      ASSERT_NEAR(planes / 24., light[static_cast<std::size_t>(level)], 1 / 24.) << level;
  }
}

TEST(ColourPlanes, EachColourIsDitheredAndEachPlaneIsItsOwnDrawing) {
  const auto packer = make_packer(settings(Packing::planes_8x3), kWidth, kHeight);
  const auto light = light_of_levels();
  for (const std::uint32_t colour : {0xff0000ffu, 0xff00c080u, 0xff4080f0u}) {
    packer->begin(1);
    packer->add(flat(colour).view(), kAll, 0, 8);
    for (const int shift : {0, 8, 16}) {
      double sum = 0;
      for (int k = 0; k < 8; ++k) {
        const auto plane = test::plane_of_8(packer->image(), k);
        for (const auto pixel : plane.pixels()) sum += (pixel >> shift & 0xff) == 255;
      }
      EXPECT_NEAR(sum / (8 * kWidth * kHeight), light[colour >> shift & 0xff], 0.005);
    }
  }
  packer->begin(1);
  for (int k = 0; k < 8; ++k)
    packer->add(flat(k % 3 == 0 ? 0xff0000ff : kOpaque).view(), kAll, k, 1);
  for (int k = 0; k < 8; ++k)
    EXPECT_THAT(test::plane_of_8(packer->image(), k).pixels(),
                testing::Each(k % 3 == 0 ? 0xffu : 0u))
        << k;
}

TEST(Quadrants, AreTheDrawingsInTheOrderOfThePropixx) {
  auto projector = settings(Packing::quadrants_4);
  projector.brightness = 0.5;
  const auto table = light_table(projector);
  const auto packer = make_packer(projector, kWidth, kHeight);
  packer->begin(1);
  for (int k = 0; k < 4; ++k)
    packer->add(
        flat(0xff000000u + 60u * static_cast<std::uint32_t>(k + 1), kWidth / 2, kHeight / 2).view(),
        {0, 0, kWidth / 2, kHeight / 2}, k, 1);
  for (int k = 0; k < 4; ++k)
    EXPECT_THAT(test::quadrant_of(packer->image(), k).pixels(),
                testing::Each(kOpaque | table[60 * k + 60]))
        << k;
}

TEST(GreyQuadrants, AreTheLuminancesOfTheDrawingsInTheOrderOfThePropixx) {
  const auto packer = make_packer(settings(Packing::quadrants_12), kWidth, kHeight);
  packer->begin(1);
  for (int k = 0; k < 12; ++k)
    packer->add(flat(grey(20 * (k + 1)), kWidth / 2, kHeight / 2).view(),
                {0, 0, kWidth / 2, kHeight / 2}, k, 1);
  for (int k = 0; k < 12; ++k)
    EXPECT_THAT(
        test::grey_quadrant_of(packer->image(), k).pixels(),
        testing::Each(testing::AllOf(testing::Ge(20 * (k + 1) - 1), testing::Le(20 * (k + 1) + 1))))
        << k;
}

TEST(GreyQuadrants, AColourHasItsShareOfTheLight) {
  const auto packer = make_packer(settings(Packing::quadrants_12), kWidth, kHeight);
  packer->begin(1);
  packer->add(flat(0xff00ff00u, kWidth / 2, kHeight / 2).view(), {0, 0, 4, 4}, 0, 1);
  const auto light = light_of_levels();
  const auto level = static_cast<std::size_t>(test::grey_quadrant_of(packer->image(), 0).at(0, 0));
  EXPECT_NEAR(light[level], 0.7152, 0.01);
}

class EveryPacking : public testing::TestWithParam<Packing> {
 protected:
  EveryPacking() {
    const int half = config::has_half_size(GetParam()) ? 2 : 1;
    width_ = kWidth / half;
    height_ = kHeight / half;
  }
  int width_ = 0, height_ = 0;  ///< of a sub-frame
  std::unique_ptr<Packer> packer_ = make_packer(settings(GetParam()), kWidth, kHeight);
};

TEST_P(EveryPacking, OnlyTheRegionIsLitAndThePixelsOfAlphaZeroAreDark) {
  auto drawing = flat(kWhite, width_, height_);  // outside of the region: left from older frames
  drawing.at(33, 11) = 0x00ffffff;
  packer_->begin(1);
  for (int k = 0; k < config::sub_frames_of(GetParam()); ++k)
    packer_->add(drawing.view(), {31, 10, 96, 20}, k, 1);
  const auto image = packer_->image();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const int in_x = x % width_, in_y = y % height_;
      const bool is_lit =
          in_x >= 31 && in_x < 96 && in_y >= 10 && in_y < 20 && !(in_x == 33 && in_y == 11);
      ASSERT_EQ(image.at(x, y), is_lit ? kWhite : kOpaque) << x << " " << y;
      if (is_lit) {
        const Rect region = packer_->region();
        ASSERT_TRUE(x >= region.x0 && x < region.x1 && y >= region.y0 && y < region.y1);
      }
    }
}

TEST_P(EveryPacking, ARegionOfAnyWidthHasItsOwnPixelsAndNoOthers) {
  const auto drawing = many_colours(width_, height_);
  const auto whole = make_packer(settings(GetParam()), kWidth, kHeight);
  const int count = config::sub_frames_of(GetParam());
  for (const int width : {0, 1, 31, 32, 33, 63, 64, 65}) {
    const Rect region{17, 9, 17 + width, 12};
    auto only_region = flat(0x00ffffff, width_, height_);
    for (int y = region.y0; y < region.y1; ++y)
      for (int x = region.x0; x < region.x1; ++x) only_region.at(x, y) = drawing.at(x, y);
    packer_->begin(1);
    whole->begin(1);
    packer_->add(drawing.view(), region, 0, count);
    whole->add(only_region.view(), {0, 0, width_, height_}, 0, count);
    EXPECT_EQ(pixels_of(*packer_), pixels_of(*whole)) << width;
    EXPECT_EQ(packer_->region().empty(), width == 0);
  }
}

TEST_P(EveryPacking, ARegionThatShrinksLeavesNoLightBehind) {
  const auto drawing = many_colours(width_, height_);
  const auto fresh = make_packer(settings(GetParam()), kWidth, kHeight);
  const int count = config::sub_frames_of(GetParam());
  packer_->begin(1);
  packer_->add(drawing.view(), {0, 0, width_, height_}, 0, count);
  for (auto* packer : {packer_.get(), fresh.get()}) {
    packer->begin(1);
    for (int k = 0; k < count; ++k)  // the last sub-frame is empty
      packer->add(drawing.view(), {5 + k, 6, 5 + 2 * k, 6 + (count - 1 - k)}, k, 1);
  }
  EXPECT_EQ(pixels_of(*packer_), pixels_of(*fresh));
}

TEST_P(EveryPacking, TheNextOutputFrameBeginsInTheDark) {
  const auto drawing = flat(kWhite, width_, height_);
  packer_->begin(1);
  packer_->add(drawing.view(), {0, 0, width_, height_}, 0, config::sub_frames_of(GetParam()));
  EXPECT_THAT(pixels_of(*packer_), testing::Each(kWhite));
  packer_->begin(1);
  EXPECT_TRUE(packer_->region().empty());
  EXPECT_THAT(pixels_of(*packer_), testing::Each(kOpaque));
}

TEST_P(EveryPacking, ADrawingInSeveralSubFramesIsTheSameAsItOneByOne) {
  const auto drawing = many_colours(width_, height_);
  const int count = config::sub_frames_of(GetParam());
  const auto one_by_one = make_packer(settings(GetParam()), kWidth, kHeight);
  packer_->begin(1);
  one_by_one->begin(1);
  packer_->add(drawing.view(), {0, 0, width_, height_}, 0, count);
  for (int k = 0; k < count; ++k) one_by_one->add(drawing.view(), {0, 0, width_, height_}, k, 1);
  EXPECT_EQ(pixels_of(*packer_), pixels_of(*one_by_one));
}

INSTANTIATE_TEST_SUITE_P(Packings, EveryPacking,
                         testing::Values(Packing::planes_24x1, Packing::planes_8x3,
                                         Packing::quadrants_4, Packing::quadrants_12),
                         [](const auto& named) {
                           return "of" + std::to_string(config::sub_frames_of(named.param));
                         });

}  // namespace
}  // namespace handcast::renderer
