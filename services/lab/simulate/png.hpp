// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

namespace handcast::simulate {

/// Writes an 8-bit grey image. Errors: bad_config (the file cannot be written).
Result<void> write_png(const std::filesystem::path& file, renderer::View<const std::uint8_t> grey);
/// The file of picture `number` in a folder: NNNNNN.png.
std::filesystem::path numbered_png(const std::filesystem::path& folder, std::size_t number);
/// Removes all files with such names from a folder, and no others. Errors: bad_config (a file
/// cannot be removed).
Result<void> remove_numbered_pngs(const std::filesystem::path& folder);
/// Writes an RGBA8 image without its alpha. Errors: bad_config (the file cannot be written).
Result<void> write_png(const std::filesystem::path& file,
                       renderer::View<const std::uint32_t> colour);

}  // namespace handcast::simulate
