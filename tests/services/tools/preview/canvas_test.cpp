// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/canvas/canvas.hpp"

#include <gmock/gmock.h>

#include <array>
#include <limits>
#include <string>

#ifdef __SANITIZE_ADDRESS__
/// Cairo keeps patterns of fontconfig until the process ends.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }
#endif

namespace handcast::preview {
namespace {

constexpr auto kBlack = Colour::of(0x000000), kRed = Colour::of(0xff0000);
constexpr std::uint32_t kRedPixel = 0xff0000ffu, kBlackPixel = 0xff000000u;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Number of pixels that are not black.
std::size_t drawn(const Canvas& canvas) {
  std::size_t count = 0;
  const auto picture = canvas.picture();
  for (const auto pixel : picture.pixels()) count += pixel != kBlackPixel;
  return count;
}

TEST(Canvas, APictureIsOpaqueRgbaOfItsSize) {
  Canvas canvas(30, 20, kRed);
  const auto picture = canvas.picture();
  EXPECT_EQ(picture.width(), 30);
  EXPECT_EQ(picture.height(), 20);
  EXPECT_THAT(picture.pixels(), testing::Each(kRedPixel));
}

TEST(Canvas, ARingIsACircleAndADiscIsFull) {
  Canvas canvas(100, 100, kBlack);
  canvas.ring({50, 50}, 30, kRed, 3);
  EXPECT_EQ(canvas.picture().at(80, 50), kRedPixel);
  EXPECT_EQ(canvas.picture().at(50, 20), kRedPixel);
  EXPECT_EQ(canvas.picture().at(50, 50), kBlackPixel);
  canvas.disc({50, 50}, 10, kRed);
  EXPECT_EQ(canvas.picture().at(50, 50), kRedPixel);
  EXPECT_EQ(canvas.picture().at(65, 50), kBlackPixel);
}

TEST(Canvas, SeparateLinesAreNotConnected) {
  Canvas canvas(100, 100, kBlack);
  const std::array<Line, 2> lines{Line{{10, 10}, {40, 10}}, Line{{10, 90}, {40, 90}}};
  canvas.stroke(lines, kRed, 3);
  EXPECT_EQ(canvas.picture().at(25, 10), kRedPixel);
  EXPECT_EQ(canvas.picture().at(25, 90), kRedPixel);
  EXPECT_EQ(canvas.picture().at(25, 50), kBlackPixel);
  EXPECT_EQ(canvas.picture().at(40, 50), kBlackPixel);
}

TEST(Canvas, AnImageFillsItsBoxAndAlphaShowsWhatIsBelow) {
  Canvas canvas(40, 40, kBlack);
  renderer::Texture image(2, 1, kRedPixel);
  image.at(1, 0) = 0;
  canvas.image(image.view(), {0, 0, 40, 20});
  EXPECT_EQ(canvas.picture().at(5, 10), kRedPixel);
  EXPECT_EQ(canvas.picture().at(35, 10), kBlackPixel);
  EXPECT_EQ(canvas.picture().at(5, 30), kBlackPixel);
}

TEST(Canvas, NothingIsDrawnOutsideOfAClip) {
  Canvas canvas(40, 40, kBlack);
  canvas.clip({0, 0, 20, 40});
  canvas.fill({0, 0, 40, 40}, kRed);
  EXPECT_EQ(canvas.picture().at(10, 10), kRedPixel);
  EXPECT_EQ(canvas.picture().at(30, 10), kBlackPixel);
  canvas.unclip();
  canvas.fill({0, 0, 40, 40}, kRed);
  EXPECT_EQ(canvas.picture().at(30, 10), kRedPixel);
}

TEST(Canvas, TextLiesOnTheChosenSideOfItsPosition) {
  for (const auto& [align, left, right] :
       {std::tuple{Align::left, false, true}, std::tuple{Align::right, true, false},
        std::tuple{Align::centre, true, true}}) {
    Canvas canvas(200, 40, kBlack);
    canvas.text({100, 30}, "handcast", {.size_px = 16, .bold = true}, kRed, align);
    bool has_left = false, has_right = false;
    const auto picture = canvas.picture();
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 200; ++x) {
        has_left |= x < 97 && picture.at(x, y) != kBlackPixel;
        has_right |= x > 103 && picture.at(x, y) != kBlackPixel;
      }
    EXPECT_EQ(has_left, left);
    EXPECT_EQ(has_right, right);
  }
}

TEST(Canvas, TextThatIsNoTextDoesNotEndTheDrawing) {
  for (const std::string text : {"\xff\xfe", "\xc3", "\xe2\x82", "a\x01\nb", "\xed\xa0\x80",
                                 "\xf0\x9f\x98\x80", "\xc0\xaf", "\xe0\x80\x80"}) {
    Canvas canvas(100, 100, kBlack);
    canvas.text({10, 20}, text, {}, kRed);
    EXPECT_GT(drawn(canvas), 0u) << "something stands for it";
    canvas.fill({50, 50, 20, 20}, kRed);
    EXPECT_EQ(canvas.picture().at(60, 60), kRedPixel);
  }
}

TEST(Canvas, NumbersThatAreNotFiniteDrawNothing) {
  Canvas canvas(50, 50, kBlack);
  canvas.disc({kNan, 10}, 5, kRed);
  canvas.disc({10, 10}, kNan, kRed);
  canvas.ring({10, kNan}, 5, kRed);
  canvas.fill({kNan, 0, 10, 10}, kRed);
  canvas.text({kNan, 10}, "text", {}, kRed);
  const std::array<Line, 1> line{Line{{kNan, 0}, {10, 10}}};
  canvas.stroke(line, kRed);
  const std::array corners{glm::vec2(0), glm::vec2(kNan, 3), glm::vec2(20, 20)};
  canvas.fill(corners, kRed);
  EXPECT_EQ(drawn(canvas), 0u);
  canvas.fill({0, 0, 50, 50}, kRed);
  EXPECT_EQ(drawn(canvas), 2500u);
}

}  // namespace
}  // namespace handcast::preview
