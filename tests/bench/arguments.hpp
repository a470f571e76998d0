// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdio>
#include <string>
#include <vector>

#include "ipc/base/command_line.hpp"
#include "tests/bench/goals.hpp"

namespace handcast::bench {

/// The command line of a benchmark: --goals FILE, and what it adds. From now on, each line of its
/// output is printed at once.
class Arguments : public CommandLine {
 public:
  Arguments(std::string name, std::string purpose)
      : CommandLine(std::move(name), std::move(purpose)) {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    add("--goals FILE", goals_file_, "Where to write the goals, as JSON");
  }

  /// Prints the goals, and writes them to the file of --goals. Returns the exit code.
  int report(const std::vector<Goal>& goals) const {
    print_goals(goals);
    return goals_file_.empty() || write_goals(goals_file_, goals) ? 0 : 1;
  }

 private:
  std::string goals_file_;
};

}  // namespace handcast::bench
