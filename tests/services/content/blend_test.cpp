// SPDX-License-Identifier: Apache-2.0
#include "services/content/blend.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace handcast::content;
using handcast::renderer::Texture;

namespace {

constexpr std::uint32_t rgba(std::uint32_t r, std::uint32_t g, std::uint32_t b, std::uint32_t a) {
  return a << 24 | b << 16 | g << 8 | r;
}

std::uint32_t blended(std::uint32_t above, std::uint32_t below, Blend how, double opacity = 1) {
  const Texture a(37, 2, above), b(37, 2, below);  // not a multiple of a vector
  Texture out(37, 2);
  blend(b.view(), a.view(), how, opacity, out);
  for (const auto pixel : out.pixels()) EXPECT_EQ(pixel, out.pixels()[0]);
  return out.pixels()[0];
}

// Half transparent above (alpha 128), opaque below.
constexpr auto kAbove = rgba(128, 64, 0, 128), kBelow = rgba(100, 200, 255, 255);

TEST(Blend, OverKeepsTheRestOfWhatIsBelow) {
  // 128 + 100 * 127 / 255 = 177.8; 64 + 200 * 127 / 255 = 163.6; 255 * 127 / 255 = 127
  EXPECT_EQ(blended(kAbove, kBelow, Blend::over), rgba(178, 164, 127, 255));
}

TEST(Blend, AddSaturates) {
  EXPECT_EQ(blended(kAbove, kBelow, Blend::add), rgba(228, 255, 255, 255));
  EXPECT_EQ(blended(rgba(10, 20, 30, 100), rgba(1, 2, 3, 100), Blend::add), rgba(11, 22, 33, 200));
}

TEST(Blend, MultiplyOfOpaquePicturesIsTheProduct) {
  EXPECT_EQ(blended(rgba(128, 255, 0, 255), kBelow, Blend::multiply), rgba(50, 200, 0, 255));
  // 128*100/255 + 0 + 100*127/255 = 100; 64*200/255 + 200*127/255 = 149.8; 0 + 127
  EXPECT_EQ(blended(kAbove, kBelow, Blend::multiply), rgba(100, 150, 127, 255));
}

TEST(Blend, ScreenIsTheProductOfTheDarkness) {
  // 128 + 100 - 50.2; 64 + 200 - 50.2; 255
  EXPECT_EQ(blended(kAbove, kBelow, Blend::screen), rgba(178, 214, 255, 255));
}

TEST(Blend, LightenAndDarkenChooseByTheColourWithoutAlpha) {
  // cs = 1, 0.5, 0 of alpha 128; cb = 100, 200, 255. Lighter: 255, 200, 255 of the part 128, and
  // what is below of the part 127: 128 + 49.8, 100.4 + 99.6, 255.
  EXPECT_EQ(blended(kAbove, kBelow, Blend::lighten), rgba(178, 200, 255, 255));
  // Darker: 100 (50.2 + 49.8), 127.5 (64 + 99.6), 0 (0 + 127).
  EXPECT_EQ(blended(kAbove, kBelow, Blend::darken), rgba(100, 164, 127, 255));
}

TEST(Blend, DifferenceOfOpaquePicturesIsTheirDistance) {
  EXPECT_EQ(blended(rgba(30, 250, 0, 255), kBelow, Blend::difference), rgba(70, 50, 255, 255));
  // 128 + 100 - 2 min(128, 50.2) = 127.6; 64 + 200 - 2 min(64, 100.4) = 136; 255
  EXPECT_EQ(blended(kAbove, kBelow, Blend::difference), rgba(128, 136, 255, 255));
}

TEST(Blend, EveryModeButAddHasTheAlphaOfBothTogether) {
  const auto above = rgba(10, 20, 30, 100), below = rgba(1, 2, 3, 50);
  for (const auto how : {Blend::over, Blend::multiply, Blend::screen, Blend::lighten, Blend::darken,
                         Blend::difference})
    EXPECT_EQ(blended(above, below, how) >> 24, 130u);  // 100 + 50 - 19.6
}

TEST(Blend, OverNothingEveryModeShowsThePictureItself) {
  for (int how = 0; how < 7; ++how)
    EXPECT_EQ(blended(kAbove, 0, static_cast<Blend>(how)), kAbove) << how;
}

TEST(Blend, NothingAboveChangesNothing) {
  for (int how = 0; how < 7; ++how) {
    EXPECT_EQ(blended(0, kBelow, static_cast<Blend>(how)), kBelow) << how;
    EXPECT_EQ(blended(0xffffffff, kBelow, static_cast<Blend>(how), 0), kBelow) << how;
  }
}

TEST(Blend, OpacityScalesColourAndAlpha) {
  EXPECT_EQ(blended(rgba(200, 100, 50, 255), 0, Blend::over, 0.4), rgba(80, 40, 20, 102));
}

TEST(Blend, IsExactForAllLevels) {
  for (std::uint32_t s = 0; s < 256; s += 5)
    for (std::uint32_t d = 0; d < 256; ++d) {
      const auto out = blended(rgba(s, s, s, 255), rgba(d, d, d, 255), Blend::multiply);
      ASSERT_EQ(out & 255, std::lround(s * d / 255.0)) << s << " " << d;
    }
}

TEST(Blend, MayBeDoneInPlace) {
  const Texture above(9, 2, kAbove);
  Texture below(9, 2, kBelow);
  blend(std::as_const(below).view(), above.view(), Blend::difference, 1, below);
  EXPECT_EQ(below.at(3, 1), rgba(128, 136, 255, 255));
}

TEST(Mix, IsTheMeanOfLevels) {
  const Texture a(3, 1, rgba(0, 100, 200, 255)), b(3, 1, rgba(200, 100, 0, 0));
  Texture out(3, 1);
  mix(a.view(), b.view(), 0.5, out);  // 128 of 255
  EXPECT_EQ(out.at(0, 0), rgba(100, 100, 100, 127));
}

TEST(Fade, IsTheMeanOfLightAndEndsExactly) {
  const Texture a(3, 1, rgba(0, 100, 255, 255)), b(3, 1, rgba(200, 100, 0, 255));
  Texture out(3, 1);
  fade(a.view(), b.view(), 0.5, out);
  EXPECT_EQ(out.at(2, 0), rgba(141, 100, 180, 255));  // 200 / sqrt 2, 255 / sqrt 2
  fade(a.view(), b.view(), 0, out);
  EXPECT_EQ(out.at(1, 0), a.at(1, 0));
  fade(a.view(), b.view(), 1, out);
  EXPECT_EQ(out.at(1, 0), b.at(1, 0));
}

}  // namespace
