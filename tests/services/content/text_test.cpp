// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "renderer/media/picture.hpp"
#include "services/content/source.hpp"

#ifdef __SANITIZE_ADDRESS__
/// Fontconfig keeps its fonts until the process ends.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }
#endif

using namespace handcast;
using namespace handcast::content;
using renderer::Rect;
using renderer::Texture;
using testing::HasSubstr;

namespace {

using Parameters = std::vector<std::pair<std::string, std::string>>;

class TextTest : public testing::Test {
 protected:
  Result<std::unique_ptr<Source>> open(std::string what, Parameters parameters = {},
                                       std::string kind = "text") {
    Opening opening;
    opening.element = {std::move(kind), std::move(what), std::move(parameters)};
    opening.meshes = {&hand_, nullptr};
    return open_source(opening);
  }
  Texture drawn(std::string what, Parameters parameters = {}, const char* name = nullptr) {
    Texture out(640, 400);
    const auto source = open(std::move(what), std::move(parameters));
    EXPECT_TRUE(source) << source.error().what;
    if (!source) return out;
    EXPECT_EQ((*source)->draw({}, {}, out), true);
    if (const char* folder = std::getenv("SHOW"); folder && name)
      (void)renderer::write_png(std::string(folder) + "/" + name + ".png",
                                std::as_const(out).view());
    return out;
  }
  /// What is painted.
  static Rect extent(const Texture& picture) {
    Rect box{};
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x)
        if (picture.at(x, y) >> 24 > 127) box = box.joined({x, y, x + 1, y + 1});
    return box;
  }

  renderer::HandMesh hand_ = *renderer::load_hand_or_default({}, Side::left);
};

TEST_F(TextTest, StandsOnTheBackUnlessItIsToldOtherwise) {
  const auto back = extent(drawn("HELLO", {}, "text"));
  const auto palm = extent(drawn("HELLO", {{"on", "palm"}}));
  const auto whole = extent(drawn("HELLO", {{"on", "whole"}}));
  EXPECT_FALSE(back.empty());
  EXPECT_LE(back.x1, 330);
  EXPECT_GE(palm.x0, 310);
  EXPECT_NEAR((whole.x0 + whole.x1) / 2, 320, 3);
  EXPECT_NEAR((whole.y0 + whole.y1) / 2, 200, 8);
}

TEST_F(TextTest, HasTheColourPremultiplied) {
  const auto picture = drawn("\u2588", {{"colour", "#ff800080"}, {"on", "whole"}, {"size", "0.5"}});
  const auto box = extent(picture);
  ASSERT_FALSE(box.empty());
  const auto pixel = picture.at((box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2);
  EXPECT_EQ(pixel >> 24, 128u);
  EXPECT_NEAR(pixel & 255, 128, 1);
  EXPECT_NEAR(pixel >> 8 & 255, 64, 1);
  EXPECT_EQ(pixel >> 16 & 255, 0u);
}

TEST_F(TextTest, BreaksLinesAtBothKindsOfBreaks) {
  const auto one = extent(drawn("A", {{"on", "whole"}}));
  const auto real = drawn("A\nA", {{"on", "whole"}});
  EXPECT_GT(extent(real).height(), 2 * one.height());
  EXPECT_EQ(real.pixels(), drawn("A\\nA", {{"on", "whole"}}).pixels());
}

TEST_F(TextTest, LongTextIsBrokenWithinTheHand) {
  const auto box = extent(drawn("a text that is much longer than a hand is wide", {}, "long"));
  EXPECT_LE(box.x1, 330);
  EXPECT_GT(box.height(), 80);
}

TEST_F(TextTest, IsTurnedAndMoved) {
  const Parameters turned{{"on", "whole"}, {"rotate", "90"}, {"x", "0.25"}, {"y", "0.75"}};
  const auto box = extent(drawn("HELLO", turned));
  EXPECT_GT(box.height(), 2 * box.width());
  EXPECT_NEAR((box.x0 + box.x1) / 2, 160, 8);
  EXPECT_NEAR((box.y0 + box.y1) / 2, 300, 3);
}

TEST_F(TextTest, RunsFromRightToLeftWhereItsScriptDoes) {
  // "HELLO" in Hebrew: its first letter, he, is at the right.
  const auto all = extent(drawn("\u05d4 ...", {{"on", "whole"}, {"align", "left"}}, "hebrew"));
  const auto latin = extent(drawn("H ...", {{"on", "whole"}, {"align", "left"}}));
  // In a paragraph from right to left, `left` is the side where lines begin: the right one.
  EXPECT_GT(all.x0, 320);
  EXPECT_LT(latin.x1, 320);
}

TEST_F(TextTest, MissingFontsAndGlyphsAreWarnings) {
  ::testing::internal::CaptureStderr();
  (void)drawn("HELLO", {{"font", "No Such Font 12"}});
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("there is no font 'No Such Font'"));
  ::testing::internal::CaptureStderr();
  const auto source = open("\U000e0fff\U00012000");  // cuneiform, and none
  Texture out(640, 400);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE((*source)->set("x", "0.4"));
    EXPECT_EQ((*source)->draw({}, {}, out), true);
  }
  const auto said = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, HasSubstr("no installed font"));
  EXPECT_EQ(said.find("no installed font"), said.rfind("no installed font"));
}

TEST_F(TextTest, EmptyAndBrokenTextsAreDrawn) {
  const auto empty = drawn("");
  for (const auto pixel : empty.pixels()) ASSERT_EQ(pixel, 0u);
  EXPECT_FALSE(extent(drawn("\xff\xfe\x80 abc")).empty());
  EXPECT_THAT(open(std::string(5000, 'a')).error().what, HasSubstr("4096"));
  EXPECT_FALSE(extent(drawn(std::string(4096, 'a'))).empty());
}

TEST_F(TextTest, IsDrawnOnceUntilItChanges) {
  auto source = open("A");
  Texture out(640, 400);
  EXPECT_EQ((*source)->draw({}, {}, out), true);
  EXPECT_EQ((*source)->draw({}, {}, out), false);
  ASSERT_TRUE((*source)->set("text", "B"));
  EXPECT_EQ((*source)->draw({}, {}, out), true);
  EXPECT_THAT((*source)->set("colour", "blueish").error().what, HasSubstr("#ff8800"));
  EXPECT_THAT((*source)->set("size", "9").error().what, HasSubstr("0.01 to 2"));
}

TEST_F(TextTest, Scrolls) {
  auto source = open("A", {{"scroll", "1"}, {"on", "whole"}, {"size", "0.1"}});
  Texture out(640, 400);
  Moment moment;
  moment.time_s = 2;
  EXPECT_EQ((*source)->draw(moment, {}, out), true);
  const auto before = extent(out);
  moment.time_s = 3;
  EXPECT_EQ((*source)->draw(moment, {}, out), true);
  EXPECT_NEAR(before.y0 - extent(out).y0, 46, 4);  // a line of a font of 40 px
}

TEST_F(TextTest, AClockIsDrawnWhenItsTextChanges) {
  auto source = open("%H:%M:%S", {}, "clock");
  ASSERT_TRUE(source) << source.error().what;
  Texture out(640, 400);
  Moment moment;
  moment.date.tm_hour = 12;
  EXPECT_EQ((*source)->draw(moment, {}, out), true);
  moment.time_s = 0.5;
  EXPECT_EQ((*source)->draw(moment, {}, out), false);
  moment.date.tm_sec = 1;
  EXPECT_EQ((*source)->draw(moment, {}, out), true);
  ASSERT_TRUE((*source)->set("text", "%H"));
  const auto before = out.pixels();
  EXPECT_EQ((*source)->draw(moment, {}, out), true);
  EXPECT_NE(before, out.pixels());
}

}  // namespace
