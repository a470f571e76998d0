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
  std::string stream;       ///< its stream
  std::uint64_t inode = 0;  ///< inode of its memory file, by which the file is recognised
  int fd = -1;              ///< number of its descriptor in all services
};

/// A rig as its supervisor saves it for a successor, which can take over the running services. The
/// file RIG.state in the runtime folder is replaced at every change (mode 0600) and removed when
/// the rig stops.
struct SavedRig {
  std::string name;                    ///< name of the rig
  std::filesystem::path rig_file;      ///< the user's rig file
  std::vector<std::string> settings;   ///< --set path=value
  std::string out;                     ///< --out; "" if it was not given
  std::int64_t epoch_ns = 0;           ///< HANDCAST_EPOCH_NS of the services
  std::vector<SavedRing> rings;        ///< its rings
  std::vector<SavedService> services;  ///< its services
};

/// Writes the file. Errors: unavailable; no successor can take over the rig then.
Result<void> save(const SavedRig& rig);
/// Reads the file. Empty if there is none, or if it was written before the last boot. Errors:
/// bad_data (the file is invalid, or another user could have written it).
Result<std::optional<SavedRig>> load_saved(const std::string& rig);
/// Removes the file. Does nothing if there is none.
void forget_saved(const std::string& rig);

}  // namespace handcast::supervisor
