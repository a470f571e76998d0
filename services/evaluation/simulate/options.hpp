// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::simulate {

/// The command line of `handcast simulate`.
struct Options {
  std::string rig_file;
  std::vector<std::string> settings;  ///< "path=value", --motion, --speed and --seed among them
  double seconds = 5;                 ///< scored time
  double warm_up_s = 0.5;             ///< run before it, not scored
  int draw_every = 8;  ///< projector frames from one drawn and scored to the next; 0: none is drawn
  int picture_every = 4;  ///< drawn frames from one picture to the next
  std::string json_file, frames_directory, trace_file, record_directory;
  bool help = false, version = false, quiet = false;
};

/// The text of --help.
std::string help();

/// Errors: bad_config, a sentence per fault.
Result<Options> parse_options(int argc, const char* const* argv);

}  // namespace handcast::simulate
