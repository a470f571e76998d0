// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/csv.hpp"
#include "ipc/base/result.hpp"

namespace handcast::sweep {

/// With this each file of results begins.
inline constexpr std::string_view kStampStart = "# handcast sweep ";

/// The cells of one line of the CSV: index, variant, axes (empty if not in the run's grid), metrics
/// (empty if not measured), error.
using Row = CsvRow;

/// The first two lines of a file of results. Files with equal headings can be merged.
///
///     # handcast sweep version=0.1.0 fingerprint=9d1c07e2a5b3f684 runs=240 plan=ladder
///     index,variant,twin.motion,...,error
struct Heading {
  std::string stamp;  ///< the first line
  Row columns;        ///< the second line

  /// Compares both lines.
  bool operator==(const Heading&) const = default;
  /// Both lines with their line ends.
  std::string print() const;
  /// Number of runs of the whole plan.
  std::size_t runs() const;
};

/// The content of a file of results. An incomplete last line is not among the rows.
struct Table {
  Heading heading;              ///< empty if the file has no complete line
  std::vector<Row> rows;        ///< in the order of the file; a run may occur several times
  std::string torn;             ///< text after the last complete line
  std::size_t whole_bytes = 0;  ///< size of all complete lines

  /// True if the file is empty or was cut off while this heading was written.
  bool is_cut_off_in(const Heading& begun) const;
  /// The index of the run of a row.
  static std::size_t index_of(const Row& row);
  /// True if the row has an error.
  static bool failed(const Row& row) { return !row.back().empty(); }
};

/// Reads a file of results. Errors: bad_config (it cannot be read), bad_data (a line that is not of
/// a sweep).
Result<Table> read_table(const std::filesystem::path& file);
/// Replaces a file: the newest row of each run, ordered by run. Errors: those of write_whole().
Result<void> write_table(const std::filesystem::path& file, const Table& table);

}  // namespace handcast::sweep
