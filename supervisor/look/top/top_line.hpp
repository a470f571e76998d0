// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace handcast::supervisor {

/// The style of a text. print() maps it to ANSI colours.
enum class Style { plain, faint, strong, heading, good, warning, bad };

/// A piece of a line in one style.
struct Span {
  std::string text;            ///< UTF-8, without control characters
  Style style = Style::plain;  ///< style of the whole text
};
/// A text in grey.
inline Span faint(std::string text) { return {std::move(text), Style::faint}; }

/// A line of the screen.
using Line = std::vector<Span>;

/// The first `columns` columns of a line.
Line cut_to(Line line, std::size_t columns);

/// The text of a line without a line break, with ANSI sequences if `with_colours`.
std::string print(const Line& line, bool with_colours);

}  // namespace handcast::supervisor
