// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace handcast::devices {

/// What a program answered.
struct Answer {
  int exit_code = 0;
  std::string text;
};

/// Runs a program, of which words[0] is the path, and returns what it wrote to its descriptor
/// `what` (STDOUT_FILENO or STDERR_FILENO). Empty if it cannot be started.
std::optional<Answer> ask(std::vector<std::string> words, int what);

}  // namespace handcast::devices
