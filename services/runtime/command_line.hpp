// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::service {

/// The command line of a daemon.
struct CommandLine {
  /// The task of the process: to work, to check the rig, or to print what an option asks for.
  enum class Task { serve, check, help, version, backends, describe };
  Task task = Task::serve;            ///< the last of these options, otherwise serve
  std::string instance;               ///< --as NAME; empty: the program's own name
  std::string config_file;            ///< --config FILE
  std::vector<std::string> settings;  ///< --set path=value, in their order
};

/// Parses a command line. Errors: bad_config, with a sentence that names the argument.
Result<CommandLine> parse_command_line(int argc, const char* const* argv);

}  // namespace handcast::service
