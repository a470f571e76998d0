// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "supervisor/look/top/top_line.hpp"

namespace handcast::supervisor {

/// A table on the screen. Columns are as wide as their contents; if there is no room, the least
/// important ones are left out.
struct Table {
  /// Alignment of the cells of a column.
  enum class Align { left, right };
  /// The description of a column.
  struct Column {
    std::string title;           ///< heading
    std::string second_title;    ///< second line of the heading, left out if empty in all columns
    Align align = Align::right;  ///< alignment of the cells
    /// Smallest width in characters, so that the table does not change when a figure gets longer.
    std::size_t least = 0;
    int importance = 0;  ///< columns with the lowest value are left out first
  };
  /// The contents of a row.
  struct Row {
    std::vector<Span> cells;  ///< one for each column
    Line note;                ///< a line below the row, cut to the width of the screen
  };

  std::vector<Column> columns;  ///< from left to right
  std::vector<Row> rows;        ///< from top to bottom
};

/// The lines of a table on a screen with this number of columns.
std::vector<Line> lay_out(const Table& table, std::size_t columns);

}  // namespace handcast::supervisor
