// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// A picture and its reductions to a half, a quarter, an eighth (Williams, "Pyramidal Parametrics",
/// SIGGRAPH 1983), for reading it at any size without aliasing. All levels lie below each other in
/// one image, so that the place of a texel follows from its level without a table:
///
///     x = 1 + column,  y = 1 + row + 2 level + 2 (padded_height - padded_height / 2^level)
///
/// A texel of a level is the mean of 2 x 2 texels of the level below, in linear light (sRGB). Each
/// level has a border, one texel wide, that repeats its edge.
class MipChain {
 public:
  /// Most levels of a chain.
  static constexpr int kMostLevels = 8;

  /// A white picture.
  MipChain() : MipChain(Texture(1, 1, 0xffffffff), true) {}
  /// Copies the picture, which must not be empty. `smooth`: it is read filtered, with all levels,
  /// and halved first while it has more than 4096 texels on a side; otherwise it has one level, of
  /// which the nearest texels are read.
  MipChain(const Texture& picture, bool smooth);

  /// Size of the picture in texels.
  /// @{
  int width() const { return width_; }
  int height() const { return height_; }
  /// @}
  /// The height, rounded up to a multiple of 2^kMostLevels.
  int padded_height() const { return padded_height_; }
  /// Number of levels, 1 to kMostLevels.
  int levels() const { return levels_; }
  /// True if the picture is read filtered.
  bool smooth() const { return smooth_; }
  /// All levels with their borders, RGBA8.
  View<const std::uint32_t> texels() const { return texels_.view(); }
  /// The texel of a level, 0 <= column < ceil(width / 2^level).
  std::uint32_t texel(int level, int column, int row) const {
    return texels_.at(1 + column, first_row(level) + row);
  }

 private:
  int first_row(int level) const {
    return 1 + 2 * level + 2 * (padded_height_ - (padded_height_ >> level));
  }

  int width_ = 0, height_ = 0, padded_height_ = 0, levels_ = 1;
  bool smooth_;
  Texture texels_;
};

}  // namespace handcast::renderer
