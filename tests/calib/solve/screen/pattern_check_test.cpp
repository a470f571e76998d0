// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "calib/solve/screen/gray_code.hpp"

namespace handcast::calib {
namespace {

constexpr int kWidth_px = 128, kHeight_px = 96;

/// What a camera sees of a pattern of `code` on white paper.
GreyPicture seen(const GrayCode& code, int pattern, int lamp = 30, unsigned seed = 1) {
  std::mt19937 random(seed + static_cast<unsigned>(pattern));
  std::normal_distribution<double> noise(0, 2);
  GreyPicture picture{kWidth_px, kHeight_px, std::vector<std::uint8_t>(kWidth_px * kHeight_px)};
  code.draw(pattern, picture.pixels.data());
  for (auto& pixel : picture.pixels)
    pixel = static_cast<std::uint8_t>(std::clamp(lamp + pixel * 0.4 + noise(random), 0.0, 255.0));
  return picture;
}

double misfit(const GreyPicture& white, const GreyPicture& black, const GreyPicture& pattern,
              const GreyPicture& inverse) {
  return pattern_misfit(white.view(), black.view(), pattern.view(), inverse.view());
}

class PatternCheck : public testing::Test {
 protected:
  const GrayCode code_{kWidth_px, kHeight_px};
  const GreyPicture white_ = seen(code_, 0), black_ = seen(code_, 1);
};

TEST_F(PatternCheck, APatternAndItsInverseAddUpToWhiteAndBlack) {
  for (int pattern = 2; pattern < code_.patterns(); pattern += 2)
    EXPECT_LT(misfit(white_, black_, seen(code_, pattern), seen(code_, pattern + 1)),
              kMostPatternMisfit / 2);
}

TEST_F(PatternCheck, AnImageOfThePatternBeforeIsFound) {
  for (int pattern = 4; pattern < code_.patterns(); pattern += 2) {
    EXPECT_GT(misfit(white_, black_, seen(code_, pattern - 1), seen(code_, pattern + 1)),
              kMostPatternMisfit)
        << pattern;
    EXPECT_GT(misfit(white_, black_, seen(code_, pattern), seen(code_, pattern, 30, 99)),
              kMostPatternMisfit)
        << pattern;
  }
}

TEST_F(PatternCheck, ALampThatFlickersIsFound) {
  EXPECT_GT(misfit(white_, black_, seen(code_, 2, 110), seen(code_, 3)), kMostPatternMisfit);
}

TEST_F(PatternCheck, NoiseInWeakLightIsNoFault) {
  const auto dim = [&](int pattern) {
    auto picture = seen(code_, pattern, 30);
    std::mt19937 random(static_cast<unsigned>(7 + pattern));
    std::normal_distribution<double> noise(0, 2.5);
    for (auto& pixel : picture.pixels)
      pixel = static_cast<std::uint8_t>(30 + (pixel - 30) * 0.25 + noise(random));
    return picture;
  };
  EXPECT_LT(misfit(dim(0), dim(1), dim(2), dim(3)), kMostPatternMisfit);
}

TEST_F(PatternCheck, NothingIsFoundWhereNothingIsLit) {
  EXPECT_EQ(misfit(black_, black_, seen(code_, 2), seen(code_, 3)), 0);
}

}  // namespace
}  // namespace handcast::calib
