// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/draw/cpu/plane.hpp"

/// @file
/// Rasterises triangles. Coverage is exact: corners are snapped to 1/16 px, edges are integers, and
/// the top-left rule gives a pixel on a shared edge to one of the two triangles. Pixel centres are
/// at whole coordinates.

namespace handcast::renderer::cpu {

/// A corner of a triangle.
struct Corner {
  /// Position in 1/16 px.
  /// @{
  std::int32_t x = 0, y = 0;
  /// @}
  /// Values that are interpolated linearly in the image.
  /// @{
  float depth = 0, u = 0, v = 0, light = 0;  // light: 0..255
  /// @}
};

/// A position in 1/16 px, rounded. Positions are clamped to +-30,000 px; NaN becomes 30,000 px.
[[gnu::always_inline]] inline std::int32_t snapped(float position_px) {
  const float below = position_px < 30'000 ? position_px : 30'000;
  const float sixteenths = 16 * (below > -30'000 ? below : -30'000);
  return static_cast<std::int32_t>(sixteenths + (sixteenths < 0 ? -0.5f : 0.5f));
}

/// The indices of the three corners of a triangle.
using TriangleIndices = std::array<std::uint16_t, 3>;

/// The sign of the area of the triangles that are drawn, x right, y down.
enum class Facing {
  both,      ///< all triangles
  positive,  ///< clockwise ones, as seen in the image
  negative,  ///< counter-clockwise ones
};

/// The winding of the near side of a closed surface. It follows from the sign of the volume between
/// the near and the far side, whether or not there is a mirror between camera and projector. A
/// surface that encloses no volume (a sheet) is drawn from both sides. `doubled_areas` is set to
/// twice the signed area of each triangle, in (1/16 px)^2.
Facing facing_of(std::span<const Corner> corners, std::span<const TriangleIndices> triangles,
                 std::vector<std::int64_t>& doubled_areas);

/// Half-open range of columns.
struct Span {
  /// First column, and one past the last.
  /// @{
  int x0 = 0, x1 = 0;
  /// @}

  /// True if the span contains no column.
  bool empty() const { return x1 <= x0; }
  /// The smallest span that contains both; an empty one is ignored.
  Span joined(Span o) const {
    return empty() ? o : o.empty() ? *this : Span{std::min(x0, o.x0), std::max(x1, o.x1)};
  }
  /// The part in [low, high); empty() if there is none.
  Span within(int low, int high) const { return {std::max(x0, low), std::min(x1, high)}; }
};

constexpr int kBlockBits = 2;
constexpr int kBlockSide = 1 << kBlockBits;      ///< width and height of a block in pixels
constexpr int kLanes = kBlockSide * kBlockSide;  ///< pixels of a block

/// 4 x 4 pixels that are tested, and later coloured, at once. The triangles of a hand are a few
/// pixels wide and taller than wide, so a square uses more of a vector than a row. Lane i is pixel
/// (i % 4, i / 4) of the block.
struct alignas(64) PixelBlock {
  float depth[kLanes];  ///< infinite where nothing was drawn
  /// The place in the picture, see TexelMap; undefined where nothing was drawn.
  /// @{
  float s[kLanes], t[kLanes];
  /// @}
  std::uint32_t tag[kLanes];  ///< see tag_of(); 0 where nothing was drawn
};

/// Rows of blocks in a band. An image is drawn band by band, so that what the rasteriser writes is
/// still in the cache when it is coloured.
constexpr int kBandRows = 8;
/// Height of a band in pixels.
constexpr int kBand = kBandRows * kBlockSide;

/// The part of the image that the rasteriser writes, in blocks.
class RasterTarget {
 public:
  /// An empty image of the given size in pixels, with its first row at the top.
  RasterTarget(int width, int height);

  /// Removes everything drawn, and moves the image down: row `first` of blocks is its first one.
  void start(int first = 0);
  /// The first block of a row of blocks.
  /// @{
  PixelBlock* row(int block_row) { return blocks_.data() + line(block_row) * columns_; }
  const PixelBlock* row(int block_row) const { return blocks_.data() + line(block_row) * columns_; }
  /// @}
  /// Blocks from one row of blocks to the next.
  int columns() const { return columns_; }
  /// What is drawn until the next start() is of another hand: what is between them is not looked
  /// at.
  void begin_other() { hand_ = rows(); }
  /// The columns of blocks in a row of blocks outside of which nothing was drawn of the hand.
  Span& drawn(int block_row) { return drawn_[hand_ + line(block_row)]; }
  /// The same of all hands: one span, or two from left to right that are apart.
  std::array<Span, 2> all_drawn(int block_row) const {
    Span left = drawn_[line(block_row)], right = drawn_[rows() + line(block_row)];
    if (left.empty() || right.empty()) return {left.joined(right), Span{}};
    if (right.x0 < left.x0) std::swap(left, right);
    if (right.x0 <= left.x1) return {left.joined(right), Span{}};
    return {left, right};
  }

  /// One pixel of a block.
  struct Pixel {
    /// The values of PixelBlock.
    /// @{
    float depth, s, t;
    std::uint32_t tag;
    /// @}
  };
  /// The pixel (x, y).
  Pixel at(int x, int y) const {
    const PixelBlock& block = row(y / kBlockSide)[x / kBlockSide];
    const int lane = y % kBlockSide * kBlockSide + x % kBlockSide;
    return {block.depth[lane], block.s[lane], block.t[lane], block.tag[lane]};
  }

 private:
  std::size_t line(int block_row) const { return static_cast<std::size_t>(block_row - first_); }

  std::size_t rows() const { return drawn_.size() / 2; }

  int columns_, first_ = 0;
  std::vector<PixelBlock> blocks_;
  std::vector<Span> drawn_;  ///< by row, of the first hand, then of the others
  std::size_t hand_ = 0;     ///< where the spans of the hand begin
};

/// How a pixel reads its picture: its light (0..255) and the level of the mip chain.
/// @{
constexpr std::uint16_t shade_of(std::uint32_t light, std::uint32_t level) {
  return static_cast<std::uint16_t>(light | level << 8);
}
constexpr std::uint32_t light_of(std::uint16_t shade) { return shade & 0xff; }
constexpr std::int32_t level_of(std::uint16_t shade) { return shade >> 8; }
/// @}

/// The tag of a pixel: the id of its surface, and its shade.
/// @{
constexpr std::uint32_t tag_of(std::uint32_t id, std::uint16_t shade) {
  return id | std::uint32_t{shade} << 8;
}
constexpr std::uint32_t id_of_tag(std::uint32_t tag) { return tag & 0xff; }
constexpr std::uint16_t shade_of_tag(std::uint32_t tag) {
  return static_cast<std::uint16_t>(tag >> 8);
}
/// @}

/// Where texture coordinates lie in a picture: (s, t) = scale (u, v) + offset. For a level of a mip
/// chain, s and t are 1/256 of a texel from the corner of the chain.
struct TexelMap {
  glm::vec2 scale{1}, offset{0}, inverse_scale{1};

  glm::vec2 place(glm::vec2 uv) const { return scale * uv + offset; }
  glm::vec2 uv(glm::vec2 place) const { return (place - offset) * inverse_scale; }
  /// The place moved into the picture: texture coordinates are clamped to 0..1; NaN becomes 0.
  glm::vec2 within(glm::vec2 place) const {
    return {std::min(std::max(offset.x, place.x), offset.x + scale.x),
            std::min(std::max(offset.y, place.y), offset.y + scale.y)};
  }
};

/// The triangles of one surface, borrowed.
struct TriangleList {
  std::span<const Corner> corners;              ///< per vertex
  std::span<const TriangleIndices> triangles;   ///< indices into `corners`
  std::span<const std::int64_t> doubled_areas;  ///< per triangle, see facing_of()
  std::span<const std::uint8_t> ids;  ///< per vertex, not 0; a triangle has the id of its first
  Facing facing = Facing::both;       ///< which triangles are drawn
  std::span<const TexelMap> levels;   ///< of the picture, at least one
  /// Size of the picture: a triangle reads the level with about one texel per pixel.
  float texels = 0;
  bool is_lit = true;  ///< false: the light of all corners is 255
};

/// The triangles of a list by the bands that they touch, in the order of the list.
class TriangleBins {
 public:
  /// Allocates nothing later for lists of at most this length, if triangles touch two bands in the
  /// mean at most.
  void reserve(std::size_t triangles);
  /// Sorts the triangles that are drawn and may touch `region`, which must not reach above or left
  /// of the image.
  void sort(const TriangleList& list, Rect region);
  /// Indices of triangles, valid until the next sort().
  std::span<const std::uint32_t> of_band(int band) const {
    return std::span(triangles_).subspan(first_[band], first_[band + 1] - first_[band]);
  }

 private:
  struct Bands {
    std::uint16_t first, end;
  };
  std::vector<Bands> bands_;          ///< per triangle of the list
  std::vector<std::uint32_t> first_;  ///< per band: index into triangles_
  std::vector<std::uint32_t> triangles_;
};

/// Draws triangles of a list into the blocks that `region` touches, which must be within the
/// target and one band. The nearer triangle wins; at equal depth, the later one.
void rasterise(const TriangleList& list, std::span<const std::uint32_t> triangles, Rect region,
               RasterTarget& target);

}  // namespace handcast::renderer::cpu
