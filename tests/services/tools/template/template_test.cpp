// SPDX-License-Identifier: Apache-2.0
#include "services/tools/template/template.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

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
    const auto lines = renderer::read_camera_picture(folder / (std::string(side) + "_lines.png"));
    ASSERT_TRUE(lines) << lines.error().what;
    EXPECT_EQ(lines->grey.width(), 512);
    EXPECT_EQ(lines->grey.height(), 320);
  }
}

TEST(Template, APaintedTemplateIsThePictureOfTheHand) {
  const test::Scratch scratch;
  ASSERT_TRUE(write_templates({}, scratch.path(), 512));
  const auto hand = renderer::load_hand_or_default({}, renderer::Side::left);
  const auto from_file = renderer::load_content((scratch.path() / "left.png").string(), *hand);
  const auto built_in = renderer::load_content("builtin:atlas", *hand);
  ASSERT_TRUE(from_file && built_in);
  EXPECT_TRUE(std::ranges::equal(from_file->pixels(), built_in->pixels()));
}

TEST(Template, LinesSurroundThePartsOfTheSurfaceAndSeparateTheBones) {
  const auto hand = renderer::load_hand_or_default({}, renderer::Side::left);
  const auto drawing = line_drawing(*hand, 1024);
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
