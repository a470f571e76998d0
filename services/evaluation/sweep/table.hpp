// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "services/evaluation/sweep/runs.hpp"

namespace handcast::sweep {

/// The cells of one line of the CSV: index, variant, the axes (empty: not turned in this run's
/// grid), the metrics (empty: never measured), and what went wrong.
using Row = std::vector<std::string>;

/// What a file of results is of; two files belong together where all of it is the same.
///
///     # handcast sweep version=0.1.0 fingerprint=9d1c07e2a5b3f684 runs=240 plan=ladder
///     index,variant,twin.motion,...,error
struct Heading {
  std::string stamp;  ///< the first line
  Row columns;        ///< the second

  bool operator==(const Heading&) const = default;
  std::string print() const;
  std::size_t runs() const;  ///< of the whole plan
};

Heading heading_of(const Plan& plan, const Expansion& expansion, std::string_view version);

/// The line of a run that was scored, and of one that could not be.
Row scored_row(const Plan& plan, const Run& run, const nlohmann::json& metrics);
Row failed_row(const Plan& plan, const Run& run, const std::string& error);

/// A column of times this machine took: they differ from one run of the same to the next.
bool is_machine_time(std::string_view column);
/// A column of figures; those between the variant and them are settings.
bool is_metric(std::string_view column);

/// With its line end. Cells with a comma or quote are quoted; a line break becomes a blank.
std::string print_row(const Row& row);
Row parse_row(std::string_view line);

/// A file of results as it stands. A last line without its end is torn and left out.
struct Table {
  Heading heading;
  std::vector<Row> rows;
  std::string torn;             ///< what stands behind the last whole line
  std::size_t whole_bytes = 0;  ///< of the file, up to the end of the last whole line

  static std::size_t index_of(const Row& row);
  static bool failed(const Row& row) { return !row.back().empty(); }
};

/// Errors: bad_config (it cannot be read), bad_data (a line is none of a sweep's).
Result<Table> read_table(const std::filesystem::path& file);
/// Writes the file anew, whole or not at all: the newest row of each index, in their order.
Result<void> write_table(const std::filesystem::path& file, const Table& table);

}  // namespace handcast::sweep
