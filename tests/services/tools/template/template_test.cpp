// SPDX-License-Identifier: Apache-2.0
#include "services/tools/template/template.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "renderer/content/chart_map.hpp"
#include "renderer/content/lettering.hpp"
#include "renderer/content/textures.hpp"
#include "renderer/media/picture.hpp"
#include "tests/scratch.hpp"

namespace handcast::picture {
namespace {

using testing::HasSubstr;

TEST(Template, EachHandHasAColouredPictureAndALineDrawing) {
  const test::Scratch scratch;
  const auto folder = scratch.path() / "a" / "b";
  const auto written = write_templates({}, folder, 512);
  ASSERT_TRUE(written) << written.error().what;
  ASSERT_EQ(written->size(), 4u);
  for (const char* side : {"left", "right"}) {
    const auto coloured = renderer::read_picture(folder / (std::string(side) + ".png"));
    ASSERT_TRUE(coloured) << coloured.error().what;
    EXPECT_EQ(coloured->width() * kProportionHeight, coloured->height() * kProportionWidth);
    const auto lines = renderer::read_grey_png(folder / (std::string(side) + "_lines.png"));
    ASSERT_TRUE(lines) << lines.error().what;
    EXPECT_EQ(lines->width(), 512);
    EXPECT_EQ(lines->height(), 320);
  }
}

/// The number of texels that differ, in the left and in the right half.
template <class Picture>
std::array<std::ptrdiff_t, 2> differences(const Picture& one, const Picture& other) {
  std::array<std::ptrdiff_t, 2> count{};
  for (int y = 0; y < one.height(); ++y)
    for (int x = 0; x < one.width(); ++x)
      count[x >= one.width() / 2] += one.at(x, y) != other.at(x, y);
  return count;
}

TEST(Template, APaintedTemplateIsThePictureOfTheHandButForItsWords) {
  const test::Scratch scratch;
  ASSERT_TRUE(write_templates({}, scratch.path(), 512));
  const auto hand = renderer::load_hand_or_default({}, renderer::Side::left);
  const auto from_file = renderer::load_content((scratch.path() / "left.png").string(), *hand);
  const auto built_in = renderer::load_content("builtin:atlas", *hand);
  ASSERT_TRUE(from_file && built_in);
  const auto all = static_cast<std::ptrdiff_t>(built_in->pixels().size());
  for (const auto half : differences(*from_file, *built_in)) {
    EXPECT_GT(half, all / 200) << "back and palm are named";
    EXPECT_LT(half, all / 20);
  }
}

/// How well a word of the size of "back" is found in a half of a line drawing 1024 px wide, 0..1.
double found(const std::string& word, const renderer::Image<std::uint8_t>& drawing, int half) {
  const auto letters = renderer::whole_lettering(word, 32);
  int best = 0;
  for (int top = 240; top < 420; ++top)
    for (int left = 512 * half + 150; left < 512 * half + 300; ++left) {
      int same = 0;
      for (int y = 0; y < letters.height(); ++y)
        for (int x = 0; x < letters.width(); ++x)
          same += (letters.at(x, y) > 127) == (drawing.at(left + x, top + y) < 223);
      best = std::max(best, same);
    }
  return static_cast<double>(best) / (letters.width() * letters.height());
}

TEST(Template, TheLineDrawingSaysWhichHalfIsTheBack) {
  for (const auto side : {renderer::Side::left, renderer::Side::right}) {
    const auto hand = renderer::load_hand_or_default({}, side);
    const auto drawing = line_drawing(*hand, "left", 1024);
    const renderer::ChartMap charts(*hand, 1024, 640);
    for (const int half : {0, 1}) {
      const bool is_back = charts.facing(charts.at(512 * half + 256, 400).chart) > 0;
      EXPECT_EQ(is_back, (half == 0) == (side == renderer::Side::left)) << "artist.md says so";
      EXPECT_GT(found(is_back ? "back" : "palm", drawing, half), 0.95);
      EXPECT_LT(found(is_back ? "palm" : "back", drawing, half), 0.92);
    }
  }
}

TEST(Template, LinesSurroundThePartsOfTheSurfaceAndSeparateTheBones) {
  const auto hand = renderer::load_hand_or_default({}, renderer::Side::left);
  const auto drawing = line_drawing(*hand, "left", 1024);
  const auto count = [&](std::uint8_t grey) { return std::ranges::count(drawing.pixels(), grey); };
  EXPECT_GT(count(0), 5'000) << "borders";
  EXPECT_GT(count(150), 500) << "between bones";
  EXPECT_GT(count(255), 400'000) << "most of it is to be painted";
}

TEST(Template, WhatHasBeenPaintedIsNotReplaced) {
  const test::Scratch scratch;
  std::ofstream(scratch.path() / "right_lines.png") << "my painting";
  const auto written = write_templates({}, scratch.path(), 512);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::bad_config);
  EXPECT_THAT(written.error().what, HasSubstr("right_lines.png exists"));
  EXPECT_FALSE(std::filesystem::exists(scratch.path() / "left.png"));
}

TEST(Template, AHandOrAFolderThatCannotBeUsedIsNamed) {
  const test::Scratch scratch;
  config::Hand hands;
  hands.right = (scratch.path() / "nowhere.glb").string();
  const auto no_hand = write_templates(hands, scratch.path() / "new", 512);
  ASSERT_FALSE(no_hand);
  EXPECT_THAT(no_hand.error().what, HasSubstr("nowhere.glb"));
  EXPECT_FALSE(std::filesystem::exists(scratch.path() / "new")) << "nor the left hand's files";
  std::ofstream(scratch.path() / "file") << "";
  const auto no_folder = write_templates({}, scratch.path() / "file" / "folder", 512);
  ASSERT_FALSE(no_folder);
  EXPECT_THAT(no_folder.error().what, HasSubstr("cannot be created"));
}

}  // namespace
}  // namespace handcast::picture
