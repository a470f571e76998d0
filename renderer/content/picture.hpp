// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

/// @file
/// Reads and writes picture files with libpng and libjpeg alone. (OpenCV's image library loads 120
/// others, which takes 80 ms at the start of every daemon that links it.)

namespace handcast::renderer {

/// Reads a PNG or JPEG file as RGBA8, opaque. Errors (bad_config): no such file, not a picture,
/// truncated, a JPEG in CMYK, larger than 8192 px on a side.
Result<Texture> read_picture(const std::filesystem::path& file);

/// Reads a PNG file as grey values. Errors (bad_config): no such file, not a readable PNG file,
/// larger than 8192 px on a side.
Result<Image<std::uint8_t>> read_grey_png(const std::filesystem::path& file);

/// Writes RGBA8 as a PNG file without alpha, by write_whole(), but not durably: there may be
/// thousands. Errors: those of it.
Result<void> write_png(const std::filesystem::path& file, View<const std::uint32_t> picture);
/// Writes grey values as a PNG file, in the same way.
Result<void> write_png(const std::filesystem::path& file, const Image<std::uint8_t>& grey);

}  // namespace handcast::renderer
