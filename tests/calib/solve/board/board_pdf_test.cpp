// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/board_pdf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <sstream>
#include <string>

#include "calib/solve/board/board_finder.hpp"

namespace handcast::calib {
namespace {

using testing::HasSubstr;

constexpr double kMm_per_pt = 25.4 / 72;
constexpr Board kPrintedCheckerboard{BoardKind::checkerboard, 10, 7, 20};
constexpr Board kPrintedCircles{BoardKind::circles, 9, 6, 20};
constexpr Board kPrintedCharuco{BoardKind::charuco, 10, 7, 20};

std::string content_of(const std::string& pdf) {
  const auto begin = pdf.find("stream\n") + 7;
  return pdf.substr(begin, pdf.find("\nendstream") - begin);
}

glm::dvec2 page_mm(const std::string& pdf) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(pdf, match, std::regex(R"(/MediaBox \[0 0 (\S+) (\S+)\])")));
  return glm::dvec2(std::stod(match[1]), std::stod(match[2])) * kMm_per_pt;
}

/// Draws what the page's paths fill, as a viewer does: rectangles, and discs by their extent.
GreyPicture rendered(const std::string& pdf, double px_per_mm) {
  const auto size_mm = page_mm(pdf);
  const int width_px = static_cast<int>(size_mm.x * px_per_mm);
  const int height_px = static_cast<int>(size_mm.y * px_per_mm);
  GreyPicture page{width_px, height_px, {}};
  page.pixels.assign(static_cast<std::size_t>(width_px * height_px), 255);
  const auto fill = [&](glm::dvec2 low_pt, glm::dvec2 high_pt, bool round) {
    const double scale = kMm_per_pt * px_per_mm;
    const glm::dvec2 begin = low_pt * scale, end = high_pt * scale;
    for (int y = static_cast<int>(begin.y); y < end.y; ++y)
      for (int x = static_cast<int>(begin.x); x < end.x; ++x) {
        const auto at = (glm::dvec2(x, y) + 0.5 - begin) / (end - begin);
        const bool inside = at.x > 0 && at.y > 0 && at.x < 1 && at.y < 1;
        if (inside && (!round || glm::distance(at, glm::dvec2(0.5)) < 0.5))
          page.pixels[static_cast<std::size_t>((height_px - 1 - y) * width_px + x)] = 0;
      }
  };
  std::istringstream lines(content_of(pdf));
  glm::dvec2 low(0), high(0);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    double a, b, c, d;
    if (line.ends_with(" re") && words >> a >> b >> c >> d) fill({a, b}, {a + c, b + d}, false);
    if (line.ends_with(" m") && words >> a >> b) low = high = {a, b};
    if (line.ends_with(" c")) {
      while (words >> a >> b) low = glm::min(low, {a, b}), high = glm::max(high, {a, b});
      if (std::abs(high.y - low.y - (high.x - low.x)) < 1e-3) fill(low, high, true);
    }
  }
  return page;
}

class EveryPdf : public testing::TestWithParam<Board> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryPdf,
                         testing::Values(kPrintedCheckerboard, kPrintedCircles, kPrintedCharuco),
                         [](const auto& test) {
                           return std::string(words_of(
                               test.param.kind)[static_cast<std::size_t>(test.param.kind)]);
                         });

TEST_P(EveryPdf, HoldsTheBoardAtTrueScale) {
  constexpr double kPx_per_mm = 4;
  const auto pdf = board_pdf(GetParam());
  const auto view = BoardFinder(GetParam()).find(rendered(pdf, kPx_per_mm).view());
  ASSERT_TRUE(view);
  ASSERT_EQ(view->ids.size(), points_of(GetParam()).size());
  const auto offset_px = view->image_px[0] - glm::dvec2(view->board_m[0]) * 1e3 * kPx_per_mm;
  for (std::size_t i = 0; i < view->ids.size(); ++i) {
    const auto expected_px = glm::dvec2(view->board_m[i]) * 1e3 * kPx_per_mm + offset_px;
    EXPECT_LT(glm::distance(view->image_px[i], expected_px), 1.2) << view->ids[i];
  }
}

TEST_P(EveryPdf, PointsOfItsTableAreWhereTheObjectsAre) {
  const auto pdf = board_pdf(GetParam());
  EXPECT_TRUE(pdf.starts_with("%PDF-1.4\n"));
  EXPECT_TRUE(pdf.ends_with("%%EOF\n"));
  const auto table_at = std::stoul(pdf.substr(pdf.find("startxref\n") + 10));
  std::istringstream table(pdf.substr(table_at));
  std::string word;
  int first, count;
  table >> word >> first >> count >> std::ws;
  EXPECT_EQ(word, "xref");
  for (int i = 0; i < count; ++i) {
    std::string entry;
    std::getline(table, entry);
    ASSERT_EQ(entry.size(), 19u) << "with its line feed, an entry has 20 bytes";
    if (i > 0) {
      EXPECT_TRUE(pdf.substr(std::stoul(entry)).starts_with(std::to_string(i) + " 0 obj\n"));
    }
  }
  EXPECT_THAT(pdf, HasSubstr("<< /Length " + std::to_string(content_of(pdf).size()) + " >>"));
}

TEST_P(EveryPdf, HasARulerOf100Millimetres) {
  const auto content = content_of(board_pdf(GetParam()));
  EXPECT_THAT(content, HasSubstr("(100 mm: measure it before use) Tj"));
  std::smatch match;
  ASSERT_TRUE(std::regex_search(content, match, std::regex(R"((\S+) \S+ m (\S+) \S+ l S)")));
  EXPECT_NEAR((std::stod(match[2]) - std::stod(match[1])) * kMm_per_pt, 100, 1e-3);
}

TEST(BoardPdf, TheCaptionSaysWhatItIs) {
  EXPECT_THAT(board_pdf(kPrintedCharuco), HasSubstr("(charuco, 10 x 7 squares of 20 mm) Tj"));
  EXPECT_THAT(board_pdf(kPrintedCircles), HasSubstr("(circles, 9 x 6, 20 mm apart) Tj"));
}

TEST(BoardPdf, ThePageIsTheSmallestThatHoldsTheBoard) {
  const auto page = [](double square_mm) {
    return page_mm(board_pdf({BoardKind::charuco, 10, 7, square_mm}));
  };
  EXPECT_LT(glm::distance(page(15), {210, 297}), 0.01);
  EXPECT_LT(glm::distance(page(20), {297, 210}), 0.01);
  EXPECT_LT(glm::distance(page(25), {297, 420}), 0.01);
  EXPECT_LT(glm::distance(page(30), {420, 297}), 0.01);
  EXPECT_GT(page(80).x, 800);
}

}  // namespace
}  // namespace handcast::calib
