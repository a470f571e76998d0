// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace handcast::chart {

/// A column of a table.
struct Column {
  std::string key;          ///< heading in CSV
  std::string heading;      ///< heading on the page, with the unit
  int digits = 2;           ///< decimals on the page
  bool of_machine = false;  ///< the figures are times of the machine; printed in italics
};

/// A text, a number, or an empty cell.
struct Cell {
  Cell() = default;
  /// A number, or an empty cell.
  Cell(std::optional<double> value) : number(value) {}
  /// A number.
  Cell(double value) : number(value) {}
  /// A text.
  Cell(std::string words) : text(std::move(words)) {}
  /// A text.
  Cell(const char* words) : text(words) {}

  std::string text;              ///< "" if the cell is a number or empty
  std::optional<double> number;  ///< not used if there is a text
};

/// The numbers behind a chart.
struct NumberTable {
  std::string name;                     ///< name of its file, without extension
  std::string caption;                  ///< explanation on the page
  std::vector<Column> columns;          ///< from left to right
  std::vector<std::vector<Cell>> rows;  ///< a cell per column
};

/// The table as the content of a CSV file.
std::string to_csv(const NumberTable& table);
/// The table as HTML; a long one is collapsed.
std::string to_html(const NumberTable& table);

}  // namespace handcast::chart
