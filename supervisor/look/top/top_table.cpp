// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/top_table.hpp"

#include <algorithm>

#include "supervisor/look/top/units_text.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::size_t kGap = 2;

std::size_t width_of(const Table& table, std::size_t column) {
  const auto& its = table.columns[column];
  auto width = std::max({its.least, columns_of(its.title), columns_of(its.second_title)});
  for (const auto& row : table.rows) width = std::max(width, columns_of(row.cells[column].text));
  return width;
}

/// The columns for which there is room, in their order.
std::vector<std::size_t> choose(const Table& table, const std::vector<std::size_t>& widths,
                                std::size_t room) {
  std::vector<std::size_t> chosen;
  std::size_t needed = 0;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    chosen.push_back(i);
    needed += widths[i] + kGap;
  }
  const auto less_important = [&](auto a, auto b) {
    return table.columns[a].importance < table.columns[b].importance;
  };
  while (chosen.size() > 1 && needed > room + kGap) {
    const auto least = std::ranges::min_element(chosen, less_important);
    needed -= widths[*least] + kGap;
    chosen.erase(least);
  }
  return chosen;
}

Span padded(Span span, std::size_t width, Table::Align align) {
  const std::size_t used = columns_of(span.text);
  const std::string padding(width > used ? width - used : 0, ' ');
  span.text = align == Table::Align::left ? span.text + padding : padding + span.text;
  return span;
}

}  // namespace

std::vector<Line> lay_out(const Table& table, std::size_t columns) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < table.columns.size(); ++i) widths.push_back(width_of(table, i));
  const auto chosen = choose(table, widths, columns);

  std::vector<Line> lines;
  const auto add = [&](const auto& cell_of) {
    Line line;
    for (const auto i : chosen) {
      if (!line.empty()) line.push_back({std::string(kGap, ' ')});
      line.push_back(padded(cell_of(i), widths[i], table.columns[i].align));
    }
    lines.push_back(cut_to(std::move(line), columns));
  };
  add([&](std::size_t i) { return Span{table.columns[i].title, Style::heading}; });
  if (std::ranges::any_of(table.columns,
                          [](const auto& column) { return !column.second_title.empty(); }))
    add([&](std::size_t i) { return Span{table.columns[i].second_title, Style::faint}; });
  for (const auto& row : table.rows) {
    add([&](std::size_t i) { return row.cells[i]; });
    if (!row.note.empty()) lines.push_back(cut_to(row.note, columns));
  }
  return lines;
}

}  // namespace handcast::supervisor
