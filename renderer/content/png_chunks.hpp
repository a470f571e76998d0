// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

/// @file
/// Makes a PNG file harmless before libpng reads it. libpng inflates texts and profiles that nobody
/// needs, 8 MB each, and all image data, also what follows the last pixel: a file of 2 MB can take
/// 20 s, or 8 GB of memory.

namespace handcast::renderer {

/// The largest width and height of a picture that is read, in pixels.
inline constexpr std::uint32_t kLargestSide = 8192;

/// A PNG file that has only what its pixels need.
struct PlainPng {
  std::string bytes;  ///< signature, header, palette, transparency, colour space, image data, end
  std::string fault;  ///< e.g. "has more image data than pixels"; empty if there is none
};

/// Leaves out all other chunks of a file, and inflates its image data to see how much there is.
/// Damage is left for libpng to find.
PlainPng plain_png(std::string_view file);

}  // namespace handcast::renderer
