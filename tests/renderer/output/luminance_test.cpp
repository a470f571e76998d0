// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/luminance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace handcast::renderer {
namespace {

double light_of(int level) {
  const double share = level / 255.;
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

std::uint32_t rgba(int red, int green, int blue) {
  return 0xff000000u | static_cast<std::uint32_t>(red | green << 8 | blue << 16);
}

TEST(Luminance, IsThatOfSrgbWithinThreeThousandthsOfWhite) {
  for (int red = 0; red < 256; red += 5)
    for (int green = 0; green < 256; green += 5)
      for (int blue = 0; blue < 256; blue += 5)
        ASSERT_NEAR(luminance(rgba(red, green, blue)) / double{kWhiteLuminance},
                    0.2126 * light_of(red) + 0.7152 * light_of(green) + 0.0722 * light_of(blue),
                    0.003)
            << red << " " << green << " " << blue;
}

TEST(Luminance, RisesWithEachGreyLevelFromBlackToWhite) {
  EXPECT_EQ(luminance(rgba(0, 0, 0)), 0);
  EXPECT_EQ(luminance(rgba(255, 255, 255)), kWhiteLuminance);
  for (int level = 2; level < 256; ++level)
    EXPECT_GT(luminance(rgba(level, level, level)),
              luminance(rgba(level - 1, level - 1, level - 1)));
}

TEST(Luminance, OfManyPixelsIsThatOfEach) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    std::array<std::uint32_t, 32> pixels, together;
    for (auto& pixel : pixels) pixel = static_cast<std::uint32_t>(random());
    pixels[static_cast<std::size_t>(i) % 32] &= 0x00ffffffu;
    luminances<32>(pixels.data(), together.data());
    for (std::size_t k = 0; k < 32; ++k) ASSERT_EQ(together[k], luminance(pixels[k])) << pixels[k];
  }
}

TEST(Luminance, IsZeroWhereTheFrameIsDark) { EXPECT_EQ(luminance(0x00ffffffu), 0); }

}  // namespace
}  // namespace handcast::renderer
