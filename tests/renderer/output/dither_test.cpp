// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/dither.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace handcast::renderer {
namespace {

class DitherTest : public testing::TestWithParam<int> {
 protected:
  Dither dither_{GetParam()};
};

TEST_P(DitherTest, ThePlanesOfAPixelHaveOneThresholdInEachNthOfTheLight) {
  const int step = dither_.thresholds() / dither_.planes();
  for (int y = 0; y < dither_.size(); ++y)
    for (int x = 0; x < dither_.size(); ++x) {
      std::set<int> nths, rests;
      for (int plane = 0; plane < dither_.planes(); ++plane) {
        nths.insert(dither_.at(plane, x, y) / step);
        rests.insert(dither_.at(plane, x, y) % step);
      }
      EXPECT_EQ(nths.size(), static_cast<std::size_t>(dither_.planes()));
      EXPECT_EQ(rests.size(), 1u);
    }
}

TEST_P(DitherTest, InTheWholePatternEachThresholdIsThereOnce) {
  std::set<int> thresholds;
  for (int plane = 0; plane < dither_.planes(); ++plane)
    for (int y = 0; y < dither_.size(); ++y)
      for (int x = 0; x < dither_.size(); ++x) thresholds.insert(dither_.at(plane, x, y));
  EXPECT_EQ(thresholds.size(), static_cast<std::size_t>(dither_.thresholds()));
  EXPECT_EQ(*thresholds.begin(), 0);
  EXPECT_EQ(*thresholds.rbegin(), dither_.thresholds() - 1);
}

TEST_P(DitherTest, EachPlaneAloneHasTheLightOfTheArea) {
  for (int plane = 0; plane < dither_.planes(); ++plane)
    for (const double light : {0.1, 0.25, 0.5, 0.8}) {
      int lit = 0;
      for (int y = 0; y < dither_.size(); ++y)
        for (int x = 0; x < dither_.size(); ++x)
          lit += dither_.at(plane, x, y) + 0.5 < light * dither_.thresholds();
      EXPECT_NEAR(lit / std::pow(dither_.size(), 2), light, 0.01) << plane;
    }
}

TEST_P(DitherTest, TheLightOfAPixelIsSpreadOverTheOutputFrame) {
  const int planes = dither_.planes();
  for (int y = 0; y < dither_.size(); ++y)
    for (int x = 0; x < dither_.size(); ++x) {
      int changes = 0;
      for (int plane = 0; plane < planes; ++plane) {
        const auto is_lit = [&](int of) {
          return dither_.at(of % planes, x, y) < dither_.thresholds() / 2;
        };
        changes += is_lit(plane) != is_lit(plane + 1);
      }
      EXPECT_GE(changes, planes / 4) << "a half of the light in one piece has two changes";
    }
}

INSTANTIATE_TEST_SUITE_P(Planes, DitherTest, testing::Values(8, 24));

TEST(BlueNoise, HasEachNumberOnceAndSpreadsTheFirstOnes) {
  const auto noise = blue_noise();
  const std::set<std::uint16_t> numbers(noise.pixels().begin(), noise.pixels().end());
  EXPECT_EQ(numbers.size(), static_cast<std::size_t>(kPatternPixels));
  EXPECT_EQ(*numbers.rbegin(), kPatternPixels - 1);
  constexpr int kBlock = 8;
  for (const int share : {8, 4, 2})
    for (int top = 0; top < kPatternSize; top += kBlock)
      for (int left = 0; left < kPatternSize; left += kBlock) {
        int first = 0;
        for (int y = top; y < top + kBlock; ++y)
          for (int x = left; x < left + kBlock; ++x)
            first += noise.at(x, y) < kPatternPixels / share;
        EXPECT_NEAR(first, kBlock * kBlock / share, 3) << "random numbers: up to 12";
      }
}

TEST(BlueNoise, IsAlwaysTheSame) { EXPECT_EQ(blue_noise().pixels(), blue_noise().pixels()); }

}  // namespace
}  // namespace handcast::renderer
