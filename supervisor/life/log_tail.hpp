// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace handcast::supervisor {

/// The newest lines of a service's output.
class LogTail {
 public:
  static constexpr std::size_t kLines = 200;         ///< number of lines that are kept
  static constexpr std::size_t kLongestLine = 4096;  ///< bytes; longer lines are split

  /// The number of reads in one turn for a living process, which may write faster than its lines
  /// are printed.
  static constexpr int kReadsAtOnce = 16;
  /// The number of reads for a process that has ended: 1 MiB, more than its pipe holds. A
  /// process that it left behind may go on writing.
  static constexpr int kAllReads = 256;

  /// Appends bytes. Calls `on_line` for each line that they complete. An error that repeats the
  /// line before it, as a service that is started again and again does, gets a short one; see
  /// leave_out_known().
  void append(std::string_view bytes, const std::function<void(std::string_view)>& on_line);
  /// Appends the bytes that a non-blocking descriptor has, in at most `most_reads` reads. Returns
  /// false at the end of the file.
  bool read_from(int fd, const std::function<void(std::string_view)>& on_line,
                 int most_reads = kReadsAtOnce);
  /// Whether lines are not printed whose sentences are among the kept ones: those of a service that
  /// waits for a device and says the same at each start.
  void leave_out_known(bool yes) { leaves_out_known_ = yes; }
  /// The newest `count` lines, oldest first.
  std::vector<std::string> last(std::size_t count) const;
  /// The newest line without the prefix of handcast's log (time, program, level). "" if there is
  /// none.
  std::string last_sentence() const;

 private:
  bool is_known(std::string_view line) const;
  void finish_line(const std::function<void(std::string_view)>& on_line);

  std::deque<std::string> lines_;
  std::string unfinished_;
  bool leaves_out_known_ = false;
};

}  // namespace handcast::supervisor
