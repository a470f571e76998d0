// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast {

/// The largest files of each kind that are read, in bytes.
inline constexpr std::uint64_t kMostText = 16 << 20;     ///< TOML, JSON, CSV
inline constexpr std::uint64_t kMostPicture = 64 << 20;  ///< PNG, JPEG
inline constexpr std::uint64_t kMostMesh = 256 << 20;    ///< glTF and its buffers
inline constexpr std::uint64_t kMostModel = 512 << 20;   ///< ONNX
inline constexpr std::uint64_t kMostArray = 256 << 20;   ///< .npy
inline constexpr std::uint64_t kMostResults = 1 << 30;   ///< CSV of a sweep: two million runs

/// Opens a file that comes from outside (rig, recording, picture, model) for reading; every such
/// file is opened here. Never blocks: a pipe, device, socket or folder is refused. Errors:
/// bad_config, with a sentence that begins with the path (it cannot be opened, is not a regular
/// file, has more than `most_bytes`).
Result<UniqueFd> open_input(const std::filesystem::path& file, std::uint64_t most_bytes);

/// The contents of such a file. Errors: as open_input().
Result<std::string> read_input(const std::filesystem::path& file, std::uint64_t most_bytes);

}  // namespace handcast
