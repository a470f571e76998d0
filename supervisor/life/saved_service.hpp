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
  std::string name;                 ///< name of the service
  pid_t pid = 0;                    ///< pid of the worker; 0: none
  std::uint64_t started_ticks = 0;  ///< start time of the worker (start_ticks_of())
  State state = State::starting;    ///< state of the service
  std::string swapped;              ///< the back end set by `handcast swap`; "": that of the rig
  std::string fingerprint;          ///< of the settings that the worker was started with
  int restarts = 0;                 ///< number of restarts
  std::uint64_t log_inode = 0;      ///< of the pipe for the worker's output; 0: unknown
};

/// A living service of a supervisor that died. The pidfd was opened before the start time was
/// compared, so it refers to the process that was saved.
struct AdoptedProcess {
  SavedService saved;  ///< the saved state
  UniqueFd pidfd;      ///< readable when the process has ended
  UniqueFd log;        ///< the reading end of its output, opened again; non-blocking
};

}  // namespace handcast::supervisor
