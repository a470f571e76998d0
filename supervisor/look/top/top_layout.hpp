// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "supervisor/look/top/top_line.hpp"
#include "supervisor/look/top/top_model.hpp"

namespace handcast::supervisor {

/// The options of a view.
struct Page {
  std::size_t columns = 100;  ///< width of the screen
  bool with_marks = true;     ///< include the rings of stage marks
};

/// The whole view, as lines of at most `page.columns` columns. If there is not enough room, the
/// least important columns of the tables are left out.
std::vector<Line> lay_out(const TopModel& model, const Page& page);

/// The lines that are visible on a screen of `columns` x `rows`: the head lines, then the others
/// from number `first` on (limited to the valid range), and a line with the keys.
std::vector<Line> fit(const std::vector<Line>& lines, std::size_t columns, std::size_t rows,
                      std::size_t& first);

}  // namespace handcast::supervisor
