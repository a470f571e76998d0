// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace handcast {

/// The cells of one line of a CSV file (RFC 4180).
using CsvRow = std::vector<std::string>;

/// Prints a line with its line end. Cells with a comma or quote are quoted; line breaks become
/// spaces.
std::string print_csv(const CsvRow& row);
/// Parses a line without its line end.
CsvRow parse_csv(std::string_view line);

}  // namespace handcast
