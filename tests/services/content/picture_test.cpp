// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "renderer/media/jpeg.hpp"
#include "services/content/scaled.hpp"
#include "services/content/source.hpp"
#include "tests/scratch.hpp"

using namespace handcast;
using namespace handcast::content;
using renderer::Texture;
using testing::HasSubstr;

namespace {

/// A PNG file of one pixel: red 200, green 100, blue 0, alpha 128.
constexpr unsigned char kHalfTransparent[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00,
    0x00, 0x1f, 0x15, 0xc4, 0x89, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x44, 0x41, 0x54, 0x78,
    0x9c, 0x63, 0x38, 0x91, 0xc2, 0xd0, 0x00, 0x00, 0x04, 0xd1, 0x01, 0xad, 0x85, 0x3c,
    0x2f, 0x4d, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

class PictureTest : public testing::Test {
 protected:
  std::string file(const char* name) { return scratch_.path() / name; }
  Result<std::unique_ptr<Source>> open(const std::string& what, std::string fit = "stretch") {
    Opening opening;
    opening.element = {"picture", what, {{"fit", fit}}};
    opening.width = 64;
    opening.height = 40;
    return open_source(opening);
  }
  Texture drawn(Source& source) {
    Texture out(64, 40);
    EXPECT_EQ(source.draw({}, {}, out), true);
    return out;
  }

  test::Scratch scratch_;
};

TEST_F(PictureTest, IsReadWithItsAlphaPremultiplied) {
  std::ofstream(file("a.png"), std::ios::binary)
      .write(reinterpret_cast<const char*>(kHalfTransparent), sizeof kHalfTransparent);
  const auto source = open(file("a.png"));
  ASSERT_TRUE(source) << source.error().what;
  EXPECT_EQ(drawn(**source).at(5, 5), 0x80004893u);  // half of the light of 200 and 100
}

TEST_F(PictureTest, IsDrawnOnceUntilItsFitChanges) {
  ASSERT_TRUE(write_png(file("a.png"), Texture(10, 10, 0xff00ff00).view()));
  auto source = open(file("a.png"));
  ASSERT_TRUE(source);
  auto out = drawn(**source);
  EXPECT_EQ((*source)->draw({}, {}, out), false);
  EXPECT_EQ(out.at(0, 20), 0xff00ff00u);
  ASSERT_TRUE((*source)->set("fit", "contain"));
  out = drawn(**source);
  EXPECT_EQ(out.at(0, 20), 0u);
  EXPECT_EQ(out.at(32, 20), 0xff00ff00u);
}

TEST_F(PictureTest, IsStaleWhenItsFileChanges) {
  ASSERT_TRUE(write_png(file("a.png"), Texture(10, 10, 0xff00ff00).view()));
  auto source = open(file("a.png"));
  EXPECT_FALSE((*source)->is_stale());
  std::filesystem::last_write_time(
      file("a.png"), std::filesystem::file_time_type::clock::now() + std::chrono::seconds(5));
  EXPECT_TRUE((*source)->is_stale());
  std::filesystem::remove(file("a.png"));  // an editor that replaces it
  EXPECT_FALSE((*source)->is_stale());
}

TEST_F(PictureTest, BadFilesAreSentences) {
  EXPECT_THAT(open(file("none.png")).error().what, HasSubstr("none.png"));
  std::ofstream(file("text.png")) << "no picture";
  EXPECT_THAT(open(file("text.png")).error().what, HasSubstr("text.png"));
  ASSERT_TRUE(write_png(file("a.png"), Texture(100, 100, 0xff123456).view()));
  std::filesystem::resize_file(file("a.png"), std::filesystem::file_size(file("a.png")) / 2);
  EXPECT_EQ(open(file("a.png")).error().code, Errc::bad_config);
  ASSERT_TRUE(write_png(file("b.png"), Texture(16384, 1, 0xff123456).view()));
  EXPECT_THAT(open(file("b.png")).error().what, HasSubstr("at most 8192 px"));
  EXPECT_THAT(open(file("a.png"), "tile").error().what, testing::Not(HasSubstr("tile")));
}

TEST_F(PictureTest, AnUnknownFitIsAnsweredWithAllFits) {
  ASSERT_TRUE(write_png(file("a.png"), Texture(10, 10, 0xff00ff00).view()));
  EXPECT_THAT(open(file("a.png"), "tile").error().what, HasSubstr("contain"));
}

TEST(Scaled, SmallerIsTheMeanOfTheAreas) {
  Texture picture(4, 2);
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 2; ++y) picture.at(x, y) = 10u * static_cast<std::uint32_t>(x + 4 * y);
  const auto half = scaled(std::as_const(picture).view(), 2, 1);
  EXPECT_EQ(half.at(0, 0), 25u);  // 0, 10, 40, 50
  EXPECT_EQ(half.at(1, 0), 45u);
  const auto third = scaled(std::as_const(picture).view(), 3, 2);
  EXPECT_EQ(third.at(0, 0), 3u);   // (0 + 10 / 3) * 3 / 4 = 2.5
  EXPECT_EQ(third.at(1, 0), 15u);  // half of each of the two in the middle
}

TEST(Scaled, LargerIsInterpolated) {
  Texture picture(2, 1);
  picture.at(1, 0) = 0xff000064u;
  const auto larger = scaled(std::as_const(picture).view(), 4, 3);
  EXPECT_EQ(larger.at(0, 2), 0u);
  EXPECT_EQ(larger.at(1, 0), 0x40000019u);
  EXPECT_EQ(larger.at(2, 1), 0xbf00004bu);
  EXPECT_EQ(larger.at(3, 1), 0xff000064u);
}

TEST(Scaled, AWhitePictureStaysWhiteInEverySize) {
  const Texture white(173, 91, 0xffffffffu);
  for (const auto& [width, height] : {std::pair{1, 1}, {64, 40}, {172, 90}, {500, 7}, {640, 400}})
    for (const auto fit : {Fit::stretch, Fit::cover}) {
      const auto other = fitted(white.view(), width, height, fit);
      for (const auto pixel : other.pixels())
        ASSERT_EQ(pixel, 0xffffffffu) << width << " x " << height;
    }
}

TEST(Fitted, CoverKeepsTheMiddle) {
  Texture picture(30, 10, 0xff000000u);
  for (int y = 0; y < 10; ++y)
    for (int x = 10; x < 20; ++x) picture.at(x, y) = 0xff0000ffu;
  const auto kept = fitted(std::as_const(picture).view(), 20, 20, Fit::cover);
  for (const auto pixel : kept.pixels()) ASSERT_EQ(pixel, 0xff0000ffu);
}

}  // namespace
