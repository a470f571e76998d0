// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/top_line.hpp"

#include <fmt/format.h>

#include <string_view>

#include "supervisor/look/top/units_text.hpp"

namespace handcast::supervisor {
namespace {

std::string_view ansi_of(Style style) {
  switch (style) {
    case Style::plain:
      return "";
    case Style::faint:
      return "\x1b[90m";
    case Style::strong:
      return "\x1b[1m";
    case Style::heading:
      return "\x1b[1;36m";
    case Style::good:
      return "\x1b[32m";
    case Style::warning:
      return "\x1b[33m";
    case Style::bad:
      return "\x1b[1;31m";
  }
  return "";
}

}  // namespace

Line cut_to(Line line, std::size_t columns) {
  Line kept;
  for (auto& span : line) {
    span.text = cut_to(span.text, columns);
    columns -= columns_of(span.text);
    kept.push_back(std::move(span));
    if (columns == 0) break;
  }
  return kept;
}

std::string print(const Line& line, bool with_colours) {
  std::string text;
  for (const auto& span : line) {
    const auto ansi = with_colours ? ansi_of(span.style) : "";
    text += ansi.empty() ? span.text : fmt::format("{}{}\x1b[0m", ansi, span.text);
  }
  if (!with_colours) text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace handcast::supervisor
