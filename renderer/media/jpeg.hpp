// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// Decodes a JPEG file as RGBA8. Errors (bad_config), each as the end of a sentence that begins
/// with the file's name ("is truncated"): not a JPEG file, truncated, in CMYK, larger than 8192 px
/// on a side.
Result<Texture> decode_jpeg(std::string_view bytes);

/// Decodes one image of a Motion JPEG stream into `grey`, which must have its size: the luma of a
/// colour image. The Huffman tables may be missing (then they are the usual ones), and so may the
/// marker at the end. Errors (bad_data), as the ends of sentences: not a JPEG image, truncated or
/// damaged, of another size, progressive.
Result<void> decode_grey_jpeg(std::span<const std::uint8_t> bytes, View<std::uint8_t> grey);

/// A picture (RGBA8, alpha is left out) as a JPEG file, with all its colour and little loss.
std::vector<std::uint8_t> jpeg_of(View<const std::uint32_t> picture);
/// The same for a screen: a third of the bytes, `quality` 1..100.
/// @{
std::vector<std::uint8_t> small_jpeg_of(View<const std::uint32_t> picture, int quality);
std::vector<std::uint8_t> small_jpeg_of(View<const std::uint8_t> grey, int quality);
/// @}

}  // namespace handcast::renderer
