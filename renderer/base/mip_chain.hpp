// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "ipc/msg/content_picture.hpp"
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// A picture and its reductions, borrowed: for reading it at any size without aliasing.
struct MipView {
  msg::MipLayout layout;
  const std::uint32_t* texels = nullptr;  ///< of all levels with their borders, RGBA8

  /// All levels with their borders.
  View<const std::uint32_t> all() const {
    return {texels, layout.stride(), layout.rows(), layout.stride()};
  }
};

/// Writes a picture, of the size of the layout, and its reductions into layout.rows() *
/// layout.stride() texels. A texel of a level is the mean of 2 x 2 texels of the level below, in
/// linear light (sRGB); alpha is the mean.
void write_mips(View<const std::uint32_t> picture, const msg::MipLayout& layout,
                std::uint32_t* texels);

/// A picture and its reductions, owned.
class MipChain {
 public:
  /// A white picture.
  MipChain() : MipChain(Texture(1, 1, 0xffffffff), true) {}
  /// Copies the picture, which must not be empty. `smooth`: MipLayout::smooth; such a picture is
  /// halved first while it has more than 4096 texels on a side.
  MipChain(const Texture& picture, bool smooth);

  /// Valid until this chain is destroyed or assigned to.
  MipView view() const { return {layout_, texels_.row(0)}; }
  /// How the texels lie.
  const msg::MipLayout& layout() const { return layout_; }
  /// The texel of a level, 0 <= column < ceil(width / 2^level).
  std::uint32_t texel(int level, int column, int row) const {
    return texels_.at(1 + column, layout_.first_row(level) + row);
  }

 private:
  msg::MipLayout layout_;
  Texture texels_;
};

}  // namespace handcast::renderer
