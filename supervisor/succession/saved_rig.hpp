// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
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

/// A rig as its supervisor saves it for a successor, which can take over the running services.
struct SavedRig {
  std::string name;                    ///< name of the rig
  std::filesystem::path rig_file;      ///< the user's rig file
  std::vector<std::string> settings;   ///< --set path=value
  std::string out;                     ///< --out; "" if it was not given
  std::string applied;                 ///< the applied rig, as TOML
  std::int64_t epoch_ns = 0;           ///< HANDCAST_EPOCH_NS of the services
  std::vector<SavedRing> rings;        ///< its rings
  std::vector<SavedService> services;  ///< its services
};

/// The text of a saved rig, one JSON object.
std::string print_saved(const SavedRig& rig);
/// The reverse. Errors: bad_data (the text is incomplete, of another version of handcast, or of
/// another rig than `name`).
Result<SavedRig> parse_saved(const std::string& text, const std::string& name);

}  // namespace handcast::supervisor
