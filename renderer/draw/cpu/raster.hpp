// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/draw/cpu/plane.hpp"

/// Triangles to pixels. Coverage is exact: corners are snapped to 1/16 px, edges are integers, and
/// the top-left rule gives a pixel on a shared edge to one of the two triangles. Pixel centres are
/// at whole coordinates.
namespace handcast::renderer::cpu {

/// A triangle's corner: its place in 1/16 px, and what is interpolated linearly across the image.
struct Corner {
  std::int32_t x = 0, y = 0;
  float depth = 0, u = 0, v = 0, light = 0;
};

/// Places beyond +-30,000 px (and NaN) are taken to be there.
[[gnu::always_inline]] inline std::int32_t snapped(float position_px) {
  const float below = position_px < 30'000 ? position_px : 30'000;
  const float sixteenths = 16 * (below > -30'000 ? below : -30'000);
  return static_cast<std::int32_t>(sixteenths + (sixteenths < 0 ? -0.5f : 0.5f));
}

using TriangleIndices = std::array<std::uint16_t, 3>;

/// The sign of a triangle's area (x right, y down; positive is clockwise to the eye) that is drawn.
enum class Facing { both, positive, negative };

/// The winding under which the near side of a closed surface is seen: nearer sides and farther
/// sides enclose a signed volume, so that mirrors between camera and projector do not matter. A
/// surface that encloses nothing (a sheet) is drawn from both sides. `doubled_areas` gets one
/// signed area per triangle, in (1/16 px)^2 times two.
Facing facing_of(std::span<const Corner> corners, std::span<const TriangleIndices> triangles,
                 std::vector<std::int64_t>& doubled_areas);

/// Half-open range of columns.
struct Span {
  int x0 = 0, x1 = 0;

  bool empty() const { return x1 <= x0; }
  Span joined(Span o) const {
    return empty() ? o : o.empty() ? *this : Span{std::min(x0, o.x0), std::max(x1, o.x1)};
  }
  Span within(int low, int high) const { return {std::max(x0, low), std::min(x1, high)}; }
};

constexpr int kBlockSide = 4;
constexpr int kLanes = kBlockSide * kBlockSide;

/// 4x4 pixels that are tested, and later coloured, at once: a hand's triangles are a few pixels
/// wide and taller than wide, so squares waste less of a vector than rows. Lane i is pixel (i % 4,
/// i / 4) of the block.
struct alignas(64) PixelBlock {
  float depth[kLanes];  ///< infinite where nothing was drawn; the rest is stale there
  float u[kLanes], v[kLanes];
  std::uint32_t tag[kLanes];  ///< light (0..256) << 8 | id
};

/// What the rasteriser writes.
class RasterTarget {
 public:
  RasterTarget(int width, int height);

  /// Forgets everything drawn.
  void clear();
  int block_rows() const { return static_cast<int>(drawn_.size()); }
  PixelBlock* row(int block_row) {
    return blocks_.data() + static_cast<std::size_t>(block_row) * columns_;
  }
  const PixelBlock* row(int block_row) const {
    return blocks_.data() + static_cast<std::size_t>(block_row) * columns_;
  }
  /// Columns of blocks of a row of blocks: nothing was drawn outside of them.
  Span& drawn(int block_row) { return drawn_[static_cast<std::size_t>(block_row)]; }

  struct Pixel {
    float depth, u, v;
    std::uint32_t tag;
  };
  Pixel at(int x, int y) const {
    const PixelBlock& block = row(y / kBlockSide)[x / kBlockSide];
    const int lane = y % kBlockSide * kBlockSide + x % kBlockSide;
    return {block.depth[lane], block.u[lane], block.v[lane], block.tag[lane]};
  }

 private:
  int columns_;
  std::vector<PixelBlock> blocks_;
  std::vector<Span> drawn_;
};

constexpr std::uint32_t id_of_tag(std::uint32_t tag) { return tag & 0xff; }
constexpr std::uint32_t light_of_tag(std::uint32_t tag) { return tag >> 8; }

/// Triangles with what is the same for all of them. `ids` and `corners` have one element per
/// vertex; a triangle bears the id of its first. `doubled_areas` as facing_of gives them.
struct TriangleList {
  std::span<const Corner> corners;
  std::span<const TriangleIndices> triangles;
  std::span<const std::int64_t> doubled_areas;
  std::span<const std::uint8_t> ids;
  Facing facing = Facing::both;
};

/// Draws into the blocks that `region` (within the image) touches. Nearer wins; at equal depth, the
/// later.
void rasterise(const TriangleList& list, Rect region, RasterTarget& target);

}  // namespace handcast::renderer::cpu
