// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ipc/base/result.hpp"

namespace handcast {

// The exit codes of every program that is called handcast: daemons, verbs and tools.

inline constexpr int kExitDone = 0;       ///< it did what it was asked to do
inline constexpr int kExitBadResult = 1;  ///< it ran to its end, and the result is bad
inline constexpr int kExitUsage = 2;      ///< the command line makes no sense
inline constexpr int kExitConfig = 100;   ///< a person must change something first
inline constexpr int kExitRetry = 111;    ///< something is missing now; trying again may help

/// The exit code of a program that ends because of an error. Bad data is a person's business here:
/// a file that is damaged stays damaged.
constexpr int exit_code_of(Errc code) {
  return code == Errc::bad_config || code == Errc::bad_data ? kExitConfig : kExitRetry;
}
constexpr int exit_code_of(const Error& error) { return exit_code_of(error.code); }

}  // namespace handcast
