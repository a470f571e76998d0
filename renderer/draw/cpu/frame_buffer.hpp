// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/base/image.hpp"
#include "renderer/draw/cpu/plane.hpp"
#include "renderer/draw/cpu/raster.hpp"
#include "renderer/draw/painter.hpp"

namespace handcast::renderer::cpu {

/// The drawing between the passes. All planes have the projector's size.
struct FrameBuffer {
  /// A dark drawing.
  FrameBuffer(int width, int height)
      : colour(width, height),
        uv(width, height),
        surface(width, height),
        light(width, height),
        lit(static_cast<std::size_t>(height)) {}

  /// Makes row `y` dark in [x0, x1), except for the span `written`, which the caller writes next.
  void darken(int y, int x0, int x1, Span written) {
    Span& row = lit[static_cast<std::size_t>(y)];
    const Span old = row.within(x0, x1);
    const auto clear = [&](int from, int to) {
      if (from >= to) return;
      std::fill(colour.row(y) + from, colour.row(y) + to, 0);
      std::fill(surface.row(y) + from, surface.row(y) + to, SurfaceId{0});
    };
    if (written.empty()) {
      clear(old.x0, old.x1);
    } else {
      clear(old.x0, std::min(old.x1, written.x0));
      clear(std::max(old.x0, written.x1), old.x1);
    }
    const bool all_seen = row.x0 >= x0 && row.x1 <= x1;
    row = all_seen ? written : row.joined(written);
  }

  Plane<std::uint32_t> colour;  ///< RGBA8, alpha 0 where dark
  Plane<glm::vec2> uv;          ///< texture coordinates; undefined where dark
  Plane<SurfaceId> surface;     ///< 0 where dark
  Plane<std::uint8_t> light;    ///< shading factor, 0..255; undefined where dark
  std::vector<Span> lit;        ///< per row: everything outside this span is dark
};

/// Looks up the nearest texel of a texture. Coordinates outside 0..1 are clamped.
struct Sampler {
  /// Borrows the texture; nullptr: white.
  explicit Sampler(const Texture* texture) {
    static const Texture kWhite(1, 1, 0xffffffff);
    if (texture == nullptr) texture = &kWhite;
    texels = texture->pixels().data();
    stride = texture->width();
    width = static_cast<float>(texture->width());
    height = static_cast<float>(texture->height());
  }

  /// The index into `texels` of the texel at texture coordinates (u, v).
  [[gnu::always_inline]] std::int32_t index(float u, float v) const {
    const auto column = static_cast<std::int32_t>(std::min(std::max(u * width, 0.f), width - 1));
    const auto line = static_cast<std::int32_t>(std::min(std::max(v * height, 0.f), height - 1));
    return line * stride + column;
  }

  const std::uint32_t* texels;  ///< RGBA8
  std::int32_t stride;          ///< texels from one row to the next
  /// Size in texels.
  /// @{
  float width, height;
  /// @}
};

/// The alpha of an opaque colour.
constexpr std::uint32_t kOpaque = 0xff000000;

/// Red, green and blue of a colour times `factor` / 256 (0..256); alpha 0.
[[gnu::always_inline]] inline std::uint32_t dimmed(std::uint32_t colour, std::uint32_t factor) {
  const std::uint32_t red_blue = ((colour & 0xff00ff) * factor >> 8) & 0xff00ff;
  const std::uint32_t green = ((colour & 0x00ff00) * factor >> 8) & 0x00ff00;
  return red_blue | green;
}

}  // namespace handcast::renderer::cpu
