// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "supervisor/life/state.hpp"

// contract
namespace handcast::supervisor {

struct SavedRing {
  std::string stream;
  std::uint64_t inode =
      0;        ///< of the memory file: tells it from whatever else has the number by now
  int fd = -1;  ///< its number in every service
};

struct SavedService {
  std::string name;
  pid_t pid = 0;  ///< of the process that works (not of a spare); 0: none
  std::uint64_t started_ticks =
      0;  ///< of that process (/proc/PID/stat, field 22): numbers are used again
  State state = State::starting;
  std::string swapped;      ///< the back end that `handcast swap` gave it; "" for the rig's own
  std::string fingerprint;  ///< of the settings it runs with (fingerprint.hpp)
  int restarts = 0;
};

/// What a supervisor leaves for its successor, so that services and picture go on when it dies.
/// Written at every change to RIG.state in the runtime folder (0600, replaced as a whole), removed
/// at an orderly stop.
struct SavedRig {
  std::string name;
  std::filesystem::path rig_file;
  std::vector<std::string> settings;  ///< --set path=value
  std::string out;                    ///< --out; "" for none
  std::int64_t epoch_ns = 0;          ///< of the services (HANDCAST_EPOCH_NS)
  std::vector<SavedRing> rings;
  std::vector<SavedService> services;
};

/// Errors: unavailable (it cannot be written: the rig goes on, its supervisor just has no heir).
Result<void> save(const SavedRig& rig);
/// Empty where nothing was left, or it was left before the machine last started. Errors: bad_data
/// (it makes no sense).
Result<std::optional<SavedRig>> load_saved(const std::string& rig);
void forget_saved(const std::string& rig);

/// Start time of a process in clock ticks since boot; empty where there is none (or only a zombie).
std::optional<std::uint64_t> start_ticks_of(pid_t pid);

}  // namespace handcast::supervisor
