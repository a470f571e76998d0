// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::sweep {

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
