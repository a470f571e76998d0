// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/runtime/context.hpp"

namespace handcast::service {

/// The command line of a daemon.
struct Options {
  const Instance* instance = nullptr;  ///< of --as NAME, otherwise the first one
  std::string config_file;             ///< --config FILE
  std::vector<std::string> settings;   ///< --set path=value, in their order
  bool check = false;                  ///< --check: prints what is wrong with the rig, and ends
  std::optional<std::string> answer;   ///< printed in place of all that
};

/// Parses the command line of the program that can be these instances. `program`: its name, if it
/// is not that of the first instance. Errors: bad_config, with a sentence that names the argument.
Result<Options> parse_options(std::span<const Instance> instances, int argc,
                              const char* const* argv, std::string_view program = {});

}  // namespace handcast::service
