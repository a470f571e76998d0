// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace handcast::supervisor {

/// The last lines that a service wrote.
class LogTail {
 public:
  static constexpr std::size_t kLines = 200;
  static constexpr std::size_t kLongestLine = 4096;  ///< bytes; what is longer is cut into lines

  /// For a process that lives: it may write faster than its lines are printed.
  static constexpr int kReadsAtOnce = 16;
  /// For a process that has ended: what is left is limited by the pipe.
  static constexpr int kAllReads = std::numeric_limits<int>::max();

  /// Takes bytes as they arrive. Calls `on_line` for each line that they complete.
  void append(std::string_view bytes, const std::function<void(std::string_view)>& on_line);
  /// Appends what can be read from a non-blocking descriptor. False: there will be no more.
  bool read_from(int fd, const std::function<void(std::string_view)>& on_line,
                 int most_reads = kReadsAtOnce);
  /// The newest `count` lines, oldest first.
  std::vector<std::string> last(std::size_t count) const;
  /// The newest line without the time, program and level that handcast's log puts in front. "" if
  /// there is none.
  std::string last_sentence() const;

 private:
  void finish_line(const std::function<void(std::string_view)>& on_line);

  std::deque<std::string> lines_;
  std::string unfinished_;
};

}  // namespace handcast::supervisor
