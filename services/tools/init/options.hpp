// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::init {

/// Answers that the command line gives before a question is asked.
struct Flags {
  std::optional<std::string> camera, output, tracker, distance, calibration, name;
};

/// The command line of `handcast init`.
struct Options {
  std::filesystem::path file = "rig.toml";  ///< to be written
  Flags flags;
  bool yes = false;    ///< no questions
  bool force = false;  ///< an existing file is replaced
  std::string text{};  ///< that --help or --version asks for; "" if the program shall run
};

/// Errors: bad_config.
Result<Options> parse(int argc, char** argv);

}  // namespace handcast::init
