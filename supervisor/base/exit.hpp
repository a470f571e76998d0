// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cstring>
#include <string>

#include "ipc/base/exit_code.hpp"

namespace handcast::supervisor {

/// How a process ended.
struct Exit {
  bool signalled = false;  ///< it was ended by a signal
  int code = 0;            ///< the exit code, or the number of the signal
  bool unknown = false;    ///< its end was not reported: it was not a child and had no keeper

  /// True for exit 0.
  bool is_success() const { return !signalled && !unknown && code == kExitDone; }
  /// True for exit 100: the process cannot work until a person changes something.
  bool asks_for_a_person() const { return !signalled && !unknown && code == kExitConfig; }
  /// True for exit 111: something that it needs is missing now.
  bool asks_to_retry() const { return !signalled && !unknown && code == kExitRetry; }
  /// "exit 100", "signal 9 (Killed)" or "end unknown".
  std::string describe() const {
    if (unknown) return "end unknown";
    return signalled ? fmt::format("signal {} ({})", code, strsignal(code))
                     : fmt::format("exit {}", code);
  }
};

}  // namespace handcast::supervisor
