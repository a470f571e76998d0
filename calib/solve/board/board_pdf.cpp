// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/board_pdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "calib/solve/board/pattern.hpp"

/// PDF 1.4, ISO 32000-1: sections 7.5 (structure of a file), 8.5 (paths), 9.4 (text).
namespace handcast::calib {
namespace {

constexpr double kPt_per_mm = 72 / 25.4;
constexpr double kRuler_mm = 100;
constexpr double kLeastMargin_mm = 10;  ///< what printers leave white
constexpr double kFoot_mm = 20;         ///< for ruler and caption
/// How far the control points of a quarter circle lie from its ends, in radii.
constexpr double kQuarter = 0.5522847498;

/// Points of the page from its bottom left corner, as PDF has them.
struct Page {
  glm::dvec2 size_mm{0};
  glm::dvec2 corner_mm{0};  ///< the pattern's top left corner, from the page's, y down
  std::string content;

  glm::dvec2 to_pt(glm::dvec2 mm) const { return glm::dvec2(mm.x, size_mm.y - mm.y) * kPt_per_mm; }
  template <class... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(content), format, std::forward<T>(values)...);
  }
};

glm::dvec2 page_for(glm::dvec2 needed_mm) {
  constexpr std::array<glm::dvec2, 4> kSheets_mm{{{210, 297}, {297, 210}, {297, 420}, {420, 297}}};
  for (const auto& sheet_mm : kSheets_mm)
    if (needed_mm.x <= sheet_mm.x && needed_mm.y <= sheet_mm.y) return sheet_mm;
  return needed_mm;
}

Page lay_out(const Board& board) {
  const glm::dvec2 pattern_mm = glm::dvec2(board.columns, board.rows) * board.square_mm;
  const double margin_mm = std::max(kLeastMargin_mm, kMargin * board.square_mm);
  Page page;
  page.size_mm = page_for(
      {std::max(pattern_mm.x, kRuler_mm) + 2 * margin_mm, pattern_mm.y + 2 * margin_mm + kFoot_mm});
  page.corner_mm = (page.size_mm - pattern_mm - glm::dvec2(0, kFoot_mm)) * 0.5;
  return page;
}

void add_disc(Page& page, glm::dvec2 c, double r) {
  const double k = r * kQuarter;
  page.add("{:.4f} {:.4f} m\n", c.x + r, c.y);
  const std::array<glm::dvec2, 4> axes{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto from = axes[i], to = axes[(i + 1) % 4];
    const auto first = c + from * r + to * k, second = c + to * r + from * k, end = c + to * r;
    page.add("{:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} c\n", first.x, first.y, second.x, second.y,
             end.x, end.y);
  }
}

/// All shapes are one path, so that viewers draw no seams between the modules of a marker.
void add_pattern(Page& page, const Board& board) {
  for (const auto& shape : pattern_of(board)) {
    const auto centre = page.to_pt(page.corner_mm + shape.centre * board.square_mm);
    const auto half = shape.half_size * board.square_mm * kPt_per_mm;
    if (shape.round)
      add_disc(page, centre, half.x);
    else
      page.add("{:.4f} {:.4f} {:.4f} {:.4f} re\n", centre.x - half.x, centre.y - half.y, 2 * half.x,
               2 * half.y);
  }
  page.add("f\n");
}

void add_line(Page& page, glm::dvec2 from_mm, glm::dvec2 to_mm) {
  const auto from = page.to_pt(from_mm), to = page.to_pt(to_mm);
  page.add("{:.4f} {:.4f} m {:.4f} {:.4f} l S\n", from.x, from.y, to.x, to.y);
}

void add_text(Page& page, glm::dvec2 at_mm, std::string_view text) {
  const auto at = page.to_pt(at_mm);
  page.add("BT /F1 9 Tf {:.4f} {:.4f} Td ({}) Tj ET\n", at.x, at.y, text);
}

void add_foot(Page& page, const Board& board) {
  const glm::dvec2 left_mm((page.size_mm.x - kRuler_mm) / 2, page.size_mm.y - kFoot_mm);
  const glm::dvec2 right_mm = left_mm + glm::dvec2(kRuler_mm, 0), tick_mm(0, 2);
  page.add("0.3 w\n");
  add_line(page, left_mm, right_mm);
  add_line(page, left_mm - tick_mm, left_mm + tick_mm);
  add_line(page, right_mm - tick_mm, right_mm + tick_mm);
  add_text(page, left_mm + glm::dvec2(2, 4), "100 mm: measure it before use");
  const auto kind = words_of(board.kind)[static_cast<std::size_t>(board.kind)];
  const auto size = board.kind == BoardKind::circles
                        ? fmt::format(", {:g} mm apart", board.square_mm)
                        : fmt::format(" squares of {:g} mm", board.square_mm);
  add_text(page, left_mm + glm::dvec2(2, 9),
           fmt::format("{}, {} x {}{}", kind, board.columns, board.rows, size));
}

/// The file of these objects, numbered from 1; the first is the catalogue.
std::string file_of(const std::vector<std::string>& objects) {
  std::string file = "%PDF-1.4\n", table = "0000000000 65535 f \n";
  for (std::size_t i = 0; i < objects.size(); ++i) {
    table += fmt::format("{:010} 00000 n \n", file.size());
    file += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
  }
  const auto table_at = file.size();
  const auto count = objects.size() + 1;
  return file +
         fmt::format("xref\n0 {}\n{}trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n",
                     count, table, count, table_at);
}

}  // namespace

std::string board_pdf(const Board& board) {
  auto page = lay_out(board);
  add_pattern(page, board);
  add_foot(page, board);
  const auto size_pt = page.size_mm * kPt_per_mm;
  return file_of({
      "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.4f} {:.4f}] /Contents 4 0 R "
                  "/Resources << /Font << /F1 5 0 R >> >> >>",
                  size_pt.x, size_pt.y),
      fmt::format("<< /Length {} >>\nstream\n{}\nendstream", page.content.size(), page.content),
      "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>",
  });
}

}  // namespace handcast::calib
