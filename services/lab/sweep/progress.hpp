// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>

namespace handcast::sweep {

/// Prints the progress of a sweep on stderr: one line that is overwritten on a terminal, else a
/// line every 10 %. Thread-safe.
class Progress {
 public:
  /// `plan` is printed before the progress. If `quiet`, only say() prints.
  Progress(std::string plan, std::size_t runs, bool quiet);
  /// Ends the line on a terminal.
  ~Progress();

  /// Counts a run.
  void one_done(bool failed);
  /// Prints a message on a line of its own.
  void say(const std::string& sentence);

 private:
  void show();

  std::string plan_;
  std::size_t runs_;
  bool quiet_, terminal_;
  std::mutex mutex_;
  std::size_t done_ = 0, failed_ = 0, tenths_ = 0;
  std::int64_t start_ns_, shown_ns_ = 0;
};

}  // namespace handcast::sweep
