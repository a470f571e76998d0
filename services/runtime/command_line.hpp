// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::service {

/// What a daemon was asked on its command line.
struct CommandLine {
  enum class Task { serve, help, version, backends, describe };

  Task task = Task::serve;
  std::string config_file;            ///< --config FILE
  std::vector<std::string> settings;  ///< --set path=value, in their order
};

/// Errors: bad_config with a sentence naming the argument.
Result<CommandLine> parse_command_line(int argc, const char* const* argv);

}  // namespace handcast::service
