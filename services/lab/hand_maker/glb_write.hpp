// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "ipc/base/result.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Writes a binary glTF 2.0 file that load_hand and other programs can read: WebXR joint names, one
/// skin, the texture coordinates of the mesh. Errors: bad_data (an empty mesh), unavailable (the
/// file cannot be written).
Result<void> save_hand(const HandMesh& hand, const std::filesystem::path& file);

}  // namespace handcast::renderer
