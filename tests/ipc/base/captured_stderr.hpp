// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>

namespace handcast::samples {

/// While the object exists, stderr is a pipe, and systemd seems to have connected it with its
/// journal if `as_journal`.
class CapturedStderr {
 public:
  /// Redirects stderr.
  explicit CapturedStderr(bool as_journal) : before_(::dup(STDERR_FILENO)) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) std::abort();
    read_ = ends[0];
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[1]);
    struct stat status {};
    ::fstat(STDERR_FILENO, &status);
    const auto inode = as_journal ? status.st_ino : status.st_ino + 1;
    ::setenv("JOURNAL_STREAM", fmt::format("{}:{}", status.st_dev, inode).c_str(), 1);
  }
  ~CapturedStderr() { (void)text(); }
  CapturedStderr(const CapturedStderr&) = delete;

  /// Ends the redirection. Returns what was written to stderr, at most 4096 bytes.
  std::string text() {
    if (read_ < 0) return {};
    ::unsetenv("JOURNAL_STREAM");
    ::dup2(before_, STDERR_FILENO);  // closes the last writing end
    std::array<char, 4096> bytes{};
    const auto count = ::read(read_, bytes.data(), bytes.size());
    ::close(read_);
    ::close(before_);
    read_ = -1;
    return {bytes.data(), static_cast<std::size_t>(count > 0 ? count : 0)};
  }

 private:
  int before_, read_ = -1;
};

}  // namespace handcast::samples
