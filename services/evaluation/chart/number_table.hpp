// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace handcast::chart {

/// What a column of numbers is.
struct Column {
  std::string key;      ///< in CSV
  std::string heading;  ///< on the page, with the unit
  int digits = 2;
  bool of_machine = false;  ///< of the machine that measured: another gives another figure
};

/// Words, a number, or nothing.
struct Cell {
  Cell() = default;
  Cell(std::optional<double> value) : number(value) {}
  Cell(double value) : number(value) {}
  Cell(std::string words) : text(std::move(words)) {}
  Cell(const char* words) : text(words) {}

  std::string text;
  std::optional<double> number;
};

/// The numbers behind a chart.
struct NumberTable {
  std::string name;     ///< of its file, without ending
  std::string caption;  ///< how to read it
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

std::string to_csv(const NumberTable& table);
std::string to_html(const NumberTable& table);

}  // namespace handcast::chart
