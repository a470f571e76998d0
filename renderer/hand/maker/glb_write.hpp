// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "ipc/base/result.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Writes a binary glTF 2.0 file that load_hand and other programs read: WebXR names, one skin,
/// two-chart UV.
Result<void> save_hand(const HandMesh& hand, const std::filesystem::path& file);

}  // namespace handcast::renderer
