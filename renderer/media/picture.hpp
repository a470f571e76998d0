// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

/// @file
/// Reads and writes picture files with libspng and libjpeg alone. (OpenCV's image library loads 120
/// others, which takes 80 ms at the start of every daemon that links it.)

namespace handcast::renderer {

/// The largest width and height of a picture that is read, in pixels.
inline constexpr std::uint32_t kLargestSide = 8192;

/// Reads a PNG or JPEG file as RGBA8 in sRGB, opaque, for the light: over black where it is
/// transparent (half of the paint is half of the light), by its colour profile (ICC, sRGB or gAMA;
/// without one it is in sRGB), and turned as a viewer turns it (Exif). A profile that cannot be
/// read is a warning in the log. Errors (bad_config): no such file, not a picture, truncated, a
/// JPEG in CMYK, larger than 8192 px on a side, a PNG with more than 16 MB of texts and profiles.
Result<Texture> read_picture(const std::filesystem::path& file);
/// The same with its alpha, by which its light is multiplied: on a hand it looks as read_picture().
Result<Texture> read_premultiplied_picture(const std::filesystem::path& file);

/// An image of a camera.
struct GreyPicture {
  Image<std::uint8_t> grey;
  std::uint32_t largest = 0;  ///< the largest value of a file with 16 bits; 0 if it has fewer
};

/// Reads a PNG or JPEG file as the data of a camera, whatever it says about its colours: the values
/// of a grey file, the luma (ITU-R BT.601) of a coloured one, over black where it is transparent,
/// turned as read_picture() does. `used_bits`: of 16 bits per value, the lowest 8 to 16 that the
/// camera has; the upper 8 of these remain. Errors: as read_picture().
Result<GreyPicture> read_camera_picture(const std::filesystem::path& file, int used_bits = 16);
/// The bits, of 16, that a camera uses whose largest value is this: 8, 10, 12 or 16.
int used_bits_of(std::uint32_t largest);

/// Grey values as the bytes of a PNG file. Errors (unavailable): no memory.
Result<std::string> png_of(GreyView grey);
/// Writes RGBA8 as a PNG file without alpha, by write_whole(), but not durably: there may be
/// thousands. Errors: those of it.
Result<void> write_png(const std::filesystem::path& file, View<const std::uint32_t> picture);
/// Writes grey values as a PNG file, in the same way.
Result<void> write_png(const std::filesystem::path& file, GreyView grey);

}  // namespace handcast::renderer
