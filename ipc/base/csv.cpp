// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/csv.hpp"

#include <algorithm>

namespace handcast {
namespace {

std::string print_cell(std::string cell) {
  std::ranges::replace(cell, '\n', ' ');
  std::ranges::replace(cell, '\r', ' ');
  if (cell.find_first_of(",\"") == cell.npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

std::string print_csv(const CsvRow& row) {
  std::string line;
  for (const auto& cell : row) {
    if (&cell != &row.front()) line += ',';
    line += print_cell(cell);
  }
  line += '\n';
  return line;
}

CsvRow parse_csv(std::string_view line) {
  CsvRow row(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool doubled = quoted && line.substr(i, 2) == "\"\"";
    if (line[i] == '"' && !doubled) {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      row.emplace_back();
    } else {
      row.back() += line[i];
      if (doubled) ++i;
    }
  }
  return row;
}

}  // namespace handcast
