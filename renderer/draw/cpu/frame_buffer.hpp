// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
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
        place(width, height),
        surface(width, height),
        shade(width, height),
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
  Plane<glm::vec2> place;       ///< in the picture, see TexelMap; undefined where dark
  Plane<SurfaceId> surface;     ///< 0 where dark
  Plane<std::uint16_t> shade;   ///< see shade_of(); undefined where dark
  std::vector<Span> lit;        ///< per row: everything outside this span is dark
};

}  // namespace handcast::renderer::cpu
