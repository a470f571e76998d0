// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/csv.hpp"
#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::study {

/// A CSV file with a heading.
struct StudyTable {
  std::string name;  ///< of the file, for sentences
  CsvRow columns;
  std::vector<CsvRow> rows;  ///< each with as many cells as there are columns
  bool is_torn = false;      ///< the last line has no end and was left out

  /// The place of a column; -1 if there is none.
  int find(std::string_view column) const;
  /// The same. Errors: bad_data (there is none; the sentence names those that are there).
  Result<std::size_t> column(std::string_view column) const;
  /// A cell as a number. Errors: bad_data (it is none; the sentence has file and line).
  Result<double> number(std::size_t row, std::size_t column) const;
  /// The same, a whole number from `least` to `most`.
  Result<int> whole(std::size_t row, std::size_t column, int least, int most) const;
};

/// Reads one, with the line ends of any system. Empty lines are left out. Errors: bad_config (the
/// file cannot be read), bad_data (no heading, a line of another length).
Result<StudyTable> read_study_table(const std::filesystem::path& file);

/// A CSV file that grows while a subject works. A line that was written outlasts the program and a
/// power cut; one that was cut off is removed when the file is opened again.
class StudyLog {
 public:
  /// What of the earlier lines is kept in memory.
  enum class Keeps { all, none };
  /// Opens it, or creates it and its folder. Errors: bad_config (it cannot be written, or has other
  /// columns), unavailable (another program writes it), bad_data (it is no table).
  static Result<StudyLog> open(const std::filesystem::path& file, const CsvRow& columns,
                               Keeps keeps = Keeps::all);

  /// What was in the file when it was opened; without rows for Keeps::none, which reads a file of
  /// any size.
  const StudyTable& earlier() const { return earlier_; }
  /// Adds lines. Errors: unavailable (e.g. the disk is full).
  /// @{
  Result<void> add(const std::vector<CsvRow>& rows);
  Result<void> add(const CsvRow& row) { return add(std::vector<CsvRow>(1, row)); }
  /// @}

 private:
  StudyLog(std::filesystem::path file, UniqueFd fd, StudyTable earlier)
      : file_(std::move(file)), fd_(std::move(fd)), earlier_(std::move(earlier)) {}
  Result<void> write(std::string_view lines);

  std::filesystem::path file_;
  UniqueFd fd_;
  StudyTable earlier_;
};

/// Ends the last line of a file that people edit, if it has no end, so that a log does not take it
/// for one that was cut off. A file that is not there is left so.
void end_last_line(const std::filesystem::path& file);

}  // namespace handcast::study
