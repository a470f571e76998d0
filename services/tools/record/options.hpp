// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::record {

/// The command line of `handcast record`.
struct Options {
  std::filesystem::path folder;    ///< DIR
  std::string rig;                 ///< --rig; empty: the only one that is up
  double seconds = 0;              ///< --seconds; 0: until Ctrl-C
  std::vector<std::string> rings;  ///< --rings; empty: all
  bool npy = false;                ///< --npy
  bool convert = false;            ///< --convert
};

/// Result of parse(): what to do, or what to print.
struct Parsed {
  Options options;   ///< the command line
  std::string text;  ///< printed instead; empty: the verb runs
};

/// Reads the command line. Errors: bad_config, with a sentence.
Result<Parsed> parse(int argc, char** argv);

/// The streams of `there` that `rings` names: by its whole name, or by the part before its dot
/// ("marks" are those of all services). All if `rings` is empty. Errors: bad_config (a name that
/// fits none).
Result<std::vector<std::string>> choose(const std::vector<std::string>& rings,
                                        const std::vector<std::string>& there);

}  // namespace handcast::record
