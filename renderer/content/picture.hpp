// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

/// Picture files by libpng and libjpeg alone. (OpenCV's image library loads 120 others: 80 ms in
/// the life of every daemon that links it.)
namespace handcast::renderer {

/// A PNG or JPEG file as RGBA8, opaque. Errors (bad_config): no such file, not a picture, cut off,
/// in CMYK, larger than 8192 px.
Result<Texture> read_picture(const std::filesystem::path& file);

/// A PNG file as grey. Errors (bad_config): as above.
Result<Image<std::uint8_t>> read_grey_png(const std::filesystem::path& file);

/// Writes RGBA8 as a PNG without its alpha. Errors: unavailable.
Result<void> write_png(const std::filesystem::path& file, View<const std::uint32_t> picture);

}  // namespace handcast::renderer
