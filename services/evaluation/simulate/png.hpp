// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

namespace handcast::simulate {

Result<void> write_png(const std::filesystem::path& file, renderer::View<const std::uint8_t> grey);
/// The file of picture `number` of a folder: NNNNNN.png.
std::filesystem::path numbered_png(const std::filesystem::path& folder, std::size_t number);
/// Removes the pictures an earlier run left under such names, and no other file. Errors
/// (bad_config): one that cannot be removed.
Result<void> remove_numbered_pngs(const std::filesystem::path& folder);
/// RGBA8 pixels; alpha is not written.
Result<void> write_png(const std::filesystem::path& file,
                       renderer::View<const std::uint32_t> colour);

}  // namespace handcast::simulate
