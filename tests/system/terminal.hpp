// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "tests/system/command.hpp"

namespace handcast::system_test {

/// A `handcast` command in a terminal, at whose keys the test sits. One thread.
class Terminal {
 public:
  /// `folder`: the command's HANDCAST_SCOPE.
  Terminal(const std::filesystem::path& folder, const Arguments& arguments);
  ~Terminal();
  Terminal(const Terminal&) = delete;

  /// Waits until the command has written this after what it had written when this was called last.
  /// False after a minute, or if it has ended.
  bool says(std::string_view text);
  void press(std::string_view keys) const;
  /// Reads until the end. Returns the exit code, or 128 + the number of the signal. A command that
  /// has not ended after a minute is killed.
  int wait();
  const std::string& said() const { return said_; }  ///< so far

 private:
  bool read_some();  ///< false if the command has ended

  pid_t pid_ = -1;
  int terminal_ = -1, exit_code_ = -1;
  std::string said_;
  std::size_t heard_ = 0;
};

}  // namespace handcast::system_test
