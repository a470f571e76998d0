// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>

#include "ipc/base/unique_fd.hpp"
#include "services/evaluation/sweep/table.hpp"

namespace handcast::sweep {

/// The file a sweep writes: a line per finished run, each in the file, whole, before the next
/// begins. A sweep that was cut off goes on in the same file; runs that failed are tried again. One
/// process at a time.
class Results {
 public:
  /// Opens or makes the file, and its folder. `fresh`: what it held is forgotten.
  /// Errors: bad_config (it cannot be written, or holds something else), unavailable (another
  /// process writes it now).
  static Result<std::unique_ptr<Results>> open(const std::filesystem::path& file,
                                               const Heading& heading, bool fresh);

  /// The runs that need not be done again.
  const std::set<std::size_t>& done() const { return done_; }

  /// From any thread. Errors: unavailable (the disk is full).
  Result<void> append(const Row& row);

  /// Puts the lines in the order of the runs, the newest of each. The last call: nothing is
  /// appended after it.
  Result<void> sort();

 private:
  Results(std::filesystem::path file, UniqueFd fd) : file_(std::move(file)), fd_(std::move(fd)) {}
  Result<void> go_on(const Heading& heading);
  Result<void> write(const std::string& text);

  std::filesystem::path file_;
  UniqueFd fd_;  ///< opened to append, and locked
  std::set<std::size_t> done_;
  std::mutex one_line_at_a_time_;
  Result<void> sound_;  ///< the first line that could not be written: none may follow a torn one
};

}  // namespace handcast::sweep
