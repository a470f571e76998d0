// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "supervisor/top/top_layout.hpp"

namespace handcast::supervisor {

/// A table on a screen: columns as wide as they need to be, the least important ones left out where
/// there is no room.
struct Table {
  enum class Align { left, right };
  struct Column {
    std::string title;
    std::string
        second_title;  ///< below it; none of the table's columns has one: one line of titles
    Align align = Align::right;
    std::size_t least =
        0;  ///< columns of the screen: so that it does not jump when a figure gets longer
    int importance = 0;  ///< the lowest is left out first
  };
  struct Row {
    std::vector<Span> cells;  ///< as many as there are columns
    Line note;                ///< a line of its own below the row; cut, not wrapped
  };

  std::vector<Column> columns;
  std::vector<Row> rows;
};

std::vector<Line> lay_out(const Table& table, std::size_t columns);

/// The line's first `columns` columns.
Line cut_to(Line line, std::size_t columns);

}  // namespace handcast::supervisor
