// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ipc/msg/header.hpp"

namespace handcast::msg {

/// How a picture and its reductions to a half, a quarter, an eighth (Williams, "Pyramidal
/// Parametrics", SIGGRAPH 1983) lie below each other in one image, so that the place of a texel
/// follows from its level without a table:
///
///     x = 1 + column,  y = 1 + row + 2 level + 2 (padded_height - padded_height / 2^level)
///
/// Each level has a border, one texel wide, that repeats its edge.
struct MipLayout {
  /// Most levels.
  static constexpr int kMostLevels = 8;

  /// Size of the picture in texels, at least 1.
  /// @{
  int width = 1;
  int height = 1;
  /// @}
  /// The picture is read filtered, with all levels; otherwise it has one level, of which the
  /// nearest texels are read.
  bool smooth = true;

  /// The height, rounded up to a multiple of 2^kMostLevels.
  constexpr int padded_height() const {
    constexpr int kPad = 1 << kMostLevels;
    return (height + kPad - 1) / kPad * kPad;
  }
  /// Number of levels, 1 to kMostLevels.
  constexpr int levels() const {
    int levels = 1;
    while (smooth && levels < kMostLevels && std::max(width, height) >> levels > 0) ++levels;
    return levels;
  }
  /// The row of the first texel of a level, behind its border.
  constexpr int first_row(int level) const {
    return 1 + 2 * level + 2 * (padded_height() - (padded_height() >> level));
  }
  /// Size of the image of all levels with their borders, texels.
  /// @{
  constexpr int stride() const { return width + 2; }
  constexpr int rows() const {
    const int border = smooth ? 1 : 3;  // a nearest texel is read with those right of it and below
    return first_row(levels() - 1) + (padded_height() >> (levels() - 1)) + border;
  }
  /// @}
};

/// Largest width and height of content, texels.
inline constexpr int kLargestContent_px = 2048;

/// What is painted on one hand: RGBA8 in the texture coordinates of its mesh, row 0 at the top,
/// premultiplied. The texels of all levels follow the struct in the same slot, as MipLayout says.
/// Published by: services/content ("content.left", "content.right").  Read by:
/// services/projector.
struct ContentPicture {
  static constexpr std::string_view layout = "ContentPicture/1";  ///< see type_hash()

  Header header;  ///< frame_id: counted by the content; origin_ns: the time it was drawn for
  /// Size of the picture in texels, 1 to kLargestContent_px.
  /// @{
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  /// @}
  std::uint32_t smooth = 1;  ///< MipLayout::smooth
  std::uint32_t reserved = 0;

  /// True if the size is one of content.
  bool is_valid() const {
    const auto fits = [](std::uint32_t side) { return side >= 1 && side <= kLargestContent_px; };
    return fits(width_px) && fits(height_px);
  }
  /// Where the texels are, if is_valid().
  MipLayout mip_layout() const {
    return {static_cast<int>(width_px), static_cast<int>(height_px), smooth != 0};
  }

  /// Size in bytes of a message with a picture of `width` x `height` texels.
  static constexpr std::size_t bytes(int width, int height) {
    const MipLayout layout{width, height};
    return bytes_with_tail(sizeof(ContentPicture), static_cast<std::size_t>(layout.stride()),
                           static_cast<std::size_t>(layout.rows()), 4);
  }
  /// The first texel. Valid only if the struct lies in a slot or buffer of at least used_bytes().
  /// @{
  std::uint32_t* texels() { return reinterpret_cast<std::uint32_t*>(this + 1); }
  const std::uint32_t* texels() const { return reinterpret_cast<const std::uint32_t*>(this + 1); }
  /// @}
  /// Size of this message in bytes, texels included. The largest size_t, which fits no slot, if it
  /// is not valid.
  std::size_t used_bytes() const {
    return is_valid() ? bytes(static_cast<int>(width_px), static_cast<int>(height_px))
                      : ~std::size_t{0};
  }
};

}  // namespace handcast::msg
