// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cstring>
#include <string>

namespace handcast::supervisor {

/// Exit codes of the house: of the daemons (services/runtime/context.hpp) and of `handcast` itself.
inline constexpr int kExitUsage = 2;       ///< the command line makes no sense
inline constexpr int kExitNotRunning = 3;  ///< the rig asked for does not run
inline constexpr int kExitConfig = 100;    ///< a person must change something
inline constexpr int kExitFailure = 111;   ///< something is missing now; trying again may help

/// How a process ended.
struct Exit {
  bool signalled = false;
  int code = 0;          ///< the exit code, or the signal
  bool unknown = false;  ///< nobody could tell: it was not a child and had no keeper

  bool is_success() const { return !signalled && !unknown && code == 0; }
  bool asks_for_a_person() const { return !signalled && !unknown && code == kExitConfig; }
  std::string describe() const {
    if (unknown) return "end unknown";
    return signalled ? fmt::format("signal {} ({})", code, strsignal(code))
                     : fmt::format("exit {}", code);
  }
};

}  // namespace handcast::supervisor
