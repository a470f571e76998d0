// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <tiny_gltf.h>

#include <filesystem>

#include "ipc/base/result.hpp"

namespace handcast::renderer {

/// Reads a .gltf or .glb file with its buffers. The JSON is checked by tinygltf; that accessors
/// stay inside their buffers is not. Errors: bad_config (the file or a buffer cannot be read, is no
/// glTF, or its JSON is nested too deeply).
Result<tinygltf::Model> read_gltf(const std::filesystem::path& file);

}  // namespace handcast::renderer
