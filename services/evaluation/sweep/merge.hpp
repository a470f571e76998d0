// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::sweep {

struct Merged {
  std::size_t rows = 0, failed = 0;
  std::vector<std::size_t> missing;  ///< runs of the plan that no file has
};

/// Writes the results of shards as one file, in the order of the runs: the file one machine would
/// have written. Where two files have the same run they must agree, but for the times; where it
/// failed in one, the other counts. Errors: bad_config (a file cannot be read or written), bad_data
/// (they are of different plans, or disagree).
Result<Merged> merge(const std::vector<std::filesystem::path>& files,
                     const std::filesystem::path& into);

/// "3, 7-12".
std::string print_indices(const std::vector<std::size_t>& ascending);

}  // namespace handcast::sweep
