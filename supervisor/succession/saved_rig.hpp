// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "supervisor/life/saved_service.hpp"

namespace handcast::supervisor {

struct SavedRing {
  std::string stream;
  std::uint64_t inode =
      0;        ///< of the memory file: tells it from whatever else has the number by now
  int fd = -1;  ///< its number in every service
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

}  // namespace handcast::supervisor
