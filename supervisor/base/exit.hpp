// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cstring>
#include <string>

#include "ipc/base/exit_code.hpp"

namespace handcast::supervisor {

/// How a process ended.
struct Exit {
  bool signalled = false;
  int code = 0;          ///< the exit code, or the signal
  bool unknown = false;  ///< nobody could tell: it was not a child and had no keeper

  bool is_success() const { return !signalled && !unknown && code == kExitDone; }
  bool asks_for_a_person() const { return !signalled && !unknown && code == kExitConfig; }
  /// "exit 100", "signal 9 (Killed)", "end unknown".
  std::string describe() const {
    if (unknown) return "end unknown";
    return signalled ? fmt::format("signal {} ({})", code, strsignal(code))
                     : fmt::format("exit {}", code);
  }
};

}  // namespace handcast::supervisor
