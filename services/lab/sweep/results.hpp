// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "services/lab/sweep/table.hpp"

namespace handcast::sweep {

/// Opens a file of results, or creates it, and locks it as long as the descriptor is open. Errors:
/// bad_config (it cannot be written), unavailable (another process has locked it).
Result<UniqueFd> lock_results(const std::filesystem::path& file);

/// The output file of a sweep: a complete line per finished run. An interrupted sweep continues in
/// the same file and repeats the runs that failed. The file is locked: one process at a time.
class Results {
 public:
  /// Opens the file, or creates it and its folder. If `fresh`, results that it holds are discarded.
  /// Errors: bad_config (the file cannot be written, or does not hold results of `heading`, or, if
  /// `fresh`, of a sweep), unavailable (another process is writing it).
  static Result<std::unique_ptr<Results>> open(const std::filesystem::path& file,
                                               const Heading& heading, bool fresh);

  /// The runs that the file holds without an error. Does not change after open().
  const std::set<std::size_t>& done() const { return done_; }
  /// True if the file was last written before this program was built.
  bool is_of_an_earlier_build() const { return earlier_build_; }

  /// Appends a line. Thread-safe. Errors: unavailable (e.g. the disk is full, or the file was
  /// replaced); then all later calls fail, too.
  Result<void> append(const Row& row);

  /// Sorts the lines by run and keeps the newest of each run. Must be the last call. Errors:
  /// unavailable (the file was replaced), those of read_table and write_table.
  Result<void> sort();

 private:
  Results(std::filesystem::path file, UniqueFd fd) : file_(std::move(file)), fd_(std::move(fd)) {}
  Result<void> go_on(const Heading& heading);
  Result<void> write(const std::string& text);
  Result<void> check_in_place() const;

  std::filesystem::path file_;
  UniqueFd fd_;  ///< in append mode, and locked
  std::set<std::size_t> done_;
  bool earlier_build_ = false;
  std::mutex mutex_;
  Result<void> state_;  ///< first error of writing: no line may follow an incomplete one
};

/// The result of merge().
struct Merged {
  std::size_t rows = 0;              ///< runs in the merged file
  std::size_t failed = 0;            ///< those of them that failed
  std::vector<std::size_t> missing;  ///< runs of the plan that no file has
};

/// Merges the results of shards into one file, in the order of the runs: the file that one machine
/// would have written. If two files have the same run, they must agree except for machine times; if
/// the run failed in one of them, the other is used. Errors: bad_config (a file cannot be read;
/// `into` holds something else, or runs that no file has), bad_data (the files are of different
/// plans, or disagree), unavailable (a sweep is writing `into`), those of write_whole().
Result<Merged> merge(const std::vector<std::filesystem::path>& files,
                     const std::filesystem::path& into);

/// Prints ascending numbers with ranges: "3, 7-12".
std::string print_indices(const std::vector<std::size_t>& ascending);

}  // namespace handcast::sweep
