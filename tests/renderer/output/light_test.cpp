// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace handcast::renderer {
namespace {

config::Projector settings(double brightness, double gamma) {
  config::Projector projector;
  projector.brightness = brightness;
  projector.gamma = gamma;
  return projector;
}

TEST(LightTable, ChangesNothingOnAProjectorOfSrgbAtFullBrightness) {
  const auto table = light_table(config::Projector());
  for (int level = 0; level < 256; ++level) EXPECT_EQ(table[level], level);
}

TEST(LightTable, BlackIsNoLightAndLevelsNeverFall) {
  for (const double gamma : {0., 0.5, 1., 1.8, 2.2, 5.})
    for (const double brightness : {0., 0.1, 1.}) {
      const auto table = light_table(settings(brightness, gamma));
      EXPECT_EQ(table[0], 0);
      EXPECT_TRUE(std::ranges::is_sorted(table));
    }
}

TEST(LightTable, HalfTheBrightnessIsHalfTheLight) {
  for (const double gamma : {1., 1.8, 2.2}) {
    const auto whole = light_table(settings(1, gamma)), half = light_table(settings(0.5, gamma));
    for (const int level : {128, 200, 255}) {
      const auto light = [&](int at) { return std::pow(at / 255., gamma); };
      EXPECT_NEAR(light(half[level]), light(whole[level]) / 2, 0.005) << level << " " << gamma;
    }
  }
}

TEST(LightTable, AFadeBeginsInTheDark) {
  const auto table = light_table(config::Projector(), 0);
  EXPECT_EQ(*std::ranges::max_element(table), 0);
}

TEST(WriteLight, IsBlackWhereTheFrameIsDarkAndLeavesTheRest) {
  Image<std::uint32_t> frame(8, 4, 0x00ffffff), out(8, 4, 0x12345678);
  frame.at(3, 1) = 0xff4080c0;
  for (const double brightness : {1., 0.5}) {
    const auto table = light_table(settings(brightness, 0));
    write_light(frame.view(), {2, 1, 20, 2}, table, out.view());
    EXPECT_EQ(out.at(3, 1), 0xff000000u | static_cast<std::uint32_t>(table[0x40]) << 16 |
                                static_cast<std::uint32_t>(table[0x80]) << 8 | table[0xc0]);
    EXPECT_EQ(out.at(4, 1), 0xff000000u);
    EXPECT_EQ(out.at(7, 1), 0xff000000u);
    EXPECT_EQ(out.at(1, 1), 0x12345678u);
    EXPECT_EQ(out.at(3, 2), 0x12345678u);
  }
}

}  // namespace
}  // namespace handcast::renderer
