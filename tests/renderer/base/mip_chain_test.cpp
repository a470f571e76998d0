// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/mip_chain.hpp"

#include <gtest/gtest.h>

#include "renderer/base/srgb.hpp"

namespace handcast::renderer {
namespace {

int red(std::uint32_t rgba) { return static_cast<int>(rgba & 0xff); }

TEST(MipChain, TheFirstLevelIsThePicture) {
  Texture picture(7, 5);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x) picture.at(x, y) = 0xff000000u | static_cast<unsigned>(y << 8 | x);
  for (const bool smooth : {false, true}) {
    const MipChain chain(picture, smooth);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) ASSERT_EQ(chain.texel(0, x, y), picture.at(x, y));
  }
}

TEST(MipChain, ATexelIsTheMeanOfTheLightBelowIt) {
  Texture picture(4, 2, 0xff000000u);
  picture.at(0, 0) = picture.at(1, 1) = 0xffffffffu;
  const MipChain chain(picture, true);
  ASSERT_EQ(chain.layout().levels(), 3);
  EXPECT_NEAR(red(chain.texel(1, 0, 0)), 255 * srgb_level(0.5), 1);
  EXPECT_EQ(red(chain.texel(1, 1, 0)), 0);
  EXPECT_NEAR(red(chain.texel(2, 0, 0)), 255 * srgb_level(0.25), 1);
}

TEST(MipChain, TheLastTexelOfAnOddRowIsTheMeanOfWhatThereIs) {
  Texture picture(3, 3, 0xff000000u);
  picture.at(2, 2) = 0xffffffffu;
  const MipChain chain(picture, true);
  EXPECT_EQ(red(chain.texel(1, 1, 1)), 255);
  EXPECT_EQ(red(chain.texel(1, 0, 0)), 0);
}

TEST(MipChain, EachLevelHasABorderThatRepeatsItsEdge) {
  Texture picture(6, 5);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x)
      picture.at(x, y) = 0xff000000u | static_cast<unsigned>(40 * y << 8 | 40 * x);
  const MipChain chain(picture, true);
  for (int level = 0, width = 6, height = 5; level < chain.layout().levels();
       ++level, width = (width + 1) / 2, height = (height + 1) / 2) {
    for (int x = 0; x < width; ++x) {
      ASSERT_EQ(chain.texel(level, x, -1), chain.texel(level, x, 0)) << level;
      ASSERT_EQ(chain.texel(level, x, height), chain.texel(level, x, height - 1)) << level;
    }
    for (int y = -1; y <= height; ++y) {
      ASSERT_EQ(chain.texel(level, -1, y), chain.texel(level, 0, y)) << level;
      ASSERT_EQ(chain.texel(level, width, y), chain.texel(level, width - 1, y)) << level;
    }
  }
}

TEST(MipChain, APictureThatIsNotSmoothHasOneLevel) {
  EXPECT_EQ(MipChain(Texture(64, 64), false).layout().levels(), 1);
  EXPECT_EQ(MipChain(Texture(64, 64), true).layout().levels(), 7);
}

TEST(MipChain, AHugePictureIsHalvedFirst) {
  const MipChain chain(Texture(5000, 3, 0xff8040c0u), true);
  EXPECT_EQ(chain.layout().width, 2500);
  EXPECT_EQ(chain.layout().height, 2);
  EXPECT_EQ(chain.texel(0, 2499, 1), 0xff8040c0u);
  EXPECT_EQ(MipChain(Texture(5000, 3), false).layout().width, 5000);
}

}  // namespace
}  // namespace handcast::renderer
