// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "supervisor/top/top_model.hpp"

namespace handcast::supervisor {

enum class Style { plain, faint, strong, heading, good, warning, bad };

/// A piece of a line in one style.
struct Span {
  std::string text;
  Style style = Style::plain;
};
using Line = std::vector<Span>;

struct Page {
  std::size_t columns = 100;
  bool with_marks = true;  ///< the rings of stage marks, too
};

/// The whole view as lines of at most `page.columns` columns; what matters least is left out where
/// there is not enough room.
std::vector<Line> lay_out(const TopModel& model, const Page& page);

/// What of the lines is seen on a screen of so many rows: the first lines are always there, the
/// rest is scrolled by `first` (which is brought into bounds), the last row says which keys there
/// are.
std::vector<Line> fit(const std::vector<Line>& lines, std::size_t columns, std::size_t rows,
                      std::size_t& first);

/// Without a line's end. With colours: as ANSI sequences.
std::string print(const Line& line, bool with_colours);

}  // namespace handcast::supervisor
