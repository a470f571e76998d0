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

/// A ring as a supervisor saves it for a successor.
struct SavedRing {
  std::string stream;
  std::uint64_t inode = 0;  ///< of the memory file: tells it from another file with the same number
  int fd = -1;              ///< its number in every service
};

/// A rig as its supervisor saves it for a successor, so that services and picture go on when it
/// dies. It is written to RIG.state in the runtime folder at every change (mode 0600, replaced as a
/// whole), and removed when the rig stops.
struct SavedRig {
  std::string name;
  std::filesystem::path rig_file;
  std::vector<std::string> settings;  ///< --set path=value
  std::string out;                    ///< --out; "" for none
  std::int64_t epoch_ns = 0;          ///< of the services (HANDCAST_EPOCH_NS)
  std::vector<SavedRing> rings;
  std::vector<SavedService> services;
};

/// Writes the file. Errors: unavailable; the rig goes on, but no successor can take it over.
Result<void> save(const SavedRig& rig);
/// Reads the file. Empty if there is none, or if it was written before the machine last started.
/// Errors: bad_data (it makes no sense, or others could have written it).
Result<std::optional<SavedRig>> load_saved(const std::string& rig);
/// Removes the file.
void forget_saved(const std::string& rig);

}  // namespace handcast::supervisor
