// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::simulate {

/// The command line of `handcast simulate`.
struct Options {
  std::string rig_file;               ///< TOML file
  std::vector<std::string> settings;  ///< "path=value" of --set, --motion, --speed and --seed
  double seconds = 5;                 ///< scored time
  double warm_up_s = 0.5;             ///< time before it that is not scored
  int draw_every = 8;                 ///< every how many projector frames one is drawn; 0: never
  int picture_every = 4;              ///< every how many drawn frames one is written as a picture
  /// Files and folders to be written; "" for none.
  /// @{
  std::string json_file, frames_directory, trace_file, record_directory;
  /// @}
  /// Results of other methods that take the place of the tracker's and the detector's
  /// (exchange.hpp); "" for none.
  /// @{
  std::string poses_file, landmarks_file;
  /// @}
  bool quiet = false;  ///< no progress line
  std::string text;    ///< that --help or --version asks for; "" if the program shall run
};

/// Parses the command line. Errors: bad_config (an unknown option, a missing value or rig file, a
/// number out of range).
Result<Options> parse(int argc, const char* const* argv);
/// The same of `handcast export-twin`, which records and draws nothing.
Result<Options> parse_export(int argc, const char* const* argv);

}  // namespace handcast::simulate
