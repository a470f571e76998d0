// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "config/sections/viewpoint.hpp"
#include "services/tools/preview/layout/layout.hpp"

namespace handcast::preview {

/// The command line of `handcast preview`.
struct Options {
  std::string rig;             ///< --rig; empty: the only one that is up
  std::filesystem::path shot;  ///< --shot; empty: a window
  double after_s = 2;          ///< --after: how long the rig is watched before the picture
  Look look;                   ///< --size and --layers
  config::Viewpoint projector = config::Viewpoint::first;  ///< --second-projector
};

/// Result of parse(): what to do, or what to print.
struct Parsed {
  Options options;   ///< the command line
  std::string text;  ///< printed instead; empty: the preview runs
};

/// Reads the command line. Errors: bad_config, with a sentence.
Result<Parsed> parse(int argc, char** argv);

}  // namespace handcast::preview
