// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

/// @file
/// Reads and writes picture files with libspng and libjpeg alone. (OpenCV's image library loads 120
/// others, which takes 80 ms at the start of every daemon that links it.)

namespace handcast::renderer {

/// The largest width and height of a picture that is read, in pixels.
inline constexpr std::uint32_t kLargestSide = 8192;

/// Reads a PNG or JPEG file as RGBA8, opaque. A PNG file with 16 bits and no gamma is in linear
/// light. Errors (bad_config): no such file, not a picture, truncated, a JPEG in CMYK, larger than
/// 8192 px on a side, a PNG with more than 16 MB of texts and profiles.
Result<Texture> read_picture(const std::filesystem::path& file);

/// Reads a PNG file as grey values: colours by their luminance, over black if they are transparent.
/// Errors (bad_config): no such file, not a readable PNG file, and as read_picture().
Result<Image<std::uint8_t>> read_grey_png(const std::filesystem::path& file);

/// Writes RGBA8 as a PNG file without alpha, by write_whole(), but not durably: there may be
/// thousands. Errors: those of it.
Result<void> write_png(const std::filesystem::path& file, View<const std::uint32_t> picture);
/// Writes grey values as a PNG file, in the same way.
Result<void> write_png(const std::filesystem::path& file, GreyView grey);

}  // namespace handcast::renderer
