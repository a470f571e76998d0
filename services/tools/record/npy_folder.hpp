// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "ipc/base/result.hpp"

namespace handcast::record {

/// Writes the sensors of a recording to RECORDING/npy in the layout of Casper DPM: timestamps.npy,
/// joints_SIDE.npy, bones_SIDE.npy, landmarks_SIDE.npy and camera/NNNNNN.png. Images that are
/// damaged are left out. Errors: those of StreamReader and recording::write_messages(), bad_config
/// (the folder is there already).
Result<void> write_npy_folder(const std::filesystem::path& recording);

}  // namespace handcast::record
