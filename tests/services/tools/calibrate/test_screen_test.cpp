// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/test_screen.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace handcast::calibrate {
namespace {

constexpr const char* kLong =
    "Move the hand to the bottom right of the image, far from the camera (0.8 m).";

renderer::Image<std::uint8_t> page_of(const std::vector<std::string>& lines, int width_px,
                                      int height_px) {
  renderer::Image<std::uint8_t> picture(width_px, height_px);
  draw_text(lines, picture);
  return picture;
}

/// The number of white pixels, beside the margins of a twentieth.
int ink(const renderer::Image<std::uint8_t>& picture, bool in_margins) {
  const int dx = picture.width() / 25, dy = picture.height() / 25;
  int count = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const bool is_margin =
          x < dx || y < dy || x >= picture.width() - dx || y >= picture.height() - dy;
      if (is_margin == in_margins && picture.at(x, y) > 128) ++count;
    }
  return count;
}

TEST(TextPage, ALongSentenceIsNotCutOff) {
  for (const auto& [width_px, height_px] : {std::pair(1024, 768), {854, 480}, {1920, 1080}}) {
    const auto page = page_of({"tracker  56 %", kLong}, width_px, height_px);
    EXPECT_EQ(ink(page, true), 0) << width_px;
    EXPECT_GT(ink(page, false), 1000) << width_px;
  }
}

TEST(TextPage, AVeryLongTextIsDrawnSmaller) {
  const std::string longest = std::string(kLong) + " " + kLong + " " + kLong + " " + kLong;
  EXPECT_EQ(ink(page_of({"screen", longest, longest}, 640, 480), true), 0);
}

TEST(TextPage, LettersHaveTheirPartsBelowTheLine) {
  EXPECT_NE(ink(page_of({"pp"}, 400, 300), false), ink(page_of({"oo"}, 400, 300), false));
  const auto rows_of = [](const renderer::Image<std::uint8_t>& page) {
    int rows = 0;
    for (int y = 0; y < page.height(); ++y)
      rows += std::any_of(page.row(y), page.row(y) + page.width(), [](int v) { return v > 128; });
    return rows;
  };
  EXPECT_GT(rows_of(page_of({"pp"}, 400, 300)), rows_of(page_of({"oo"}, 400, 300)) + 2);
}

}  // namespace
}  // namespace handcast::calibrate
