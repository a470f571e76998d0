// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <string>

#include "ipc/base/unique_fd.hpp"
#include "supervisor/life/state.hpp"

namespace handcast::supervisor {

/// A service as its supervisor saves it for a successor.
struct SavedService {
  std::string name;
  pid_t pid = 0;                    ///< of the process that works (not of a spare); 0: none
  std::uint64_t started_ticks = 0;  ///< of that process (start_ticks_of)
  State state = State::starting;
  std::string swapped;      ///< the back end that `handcast swap` gave it; "" for the rig's own
  std::string fingerprint;  ///< of the settings it runs with (fingerprint_of)
  int restarts = 0;
};

/// A living service of a supervisor that died, identified beyond doubt: the pidfd was opened before
/// the start time was compared.
struct AdoptedProcess {
  SavedService saved;
  UniqueFd pidfd;
  UniqueFd log;  ///< the reading end of its output, opened again; does not block
};

}  // namespace handcast::supervisor
