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
    if (written.empty()) {
      clear(y, old.x0, old.x1);
    } else {
      clear(y, old.x0, std::min(old.x1, written.x0));
      clear(y, std::max(old.x0, written.x1), old.x1);
    }
    const bool all_seen = row.x0 >= x0 && row.x1 <= x1;
    row = all_seen ? written : row.joined(written);
  }
  /// Makes pixels [x0, x1) of row `y` dark; none if that is empty.
  void clear(int y, int x0, int x1) {
    if (x0 >= x1) return;
    std::fill(colour.row(y) + x0, colour.row(y) + x1, 0);
    std::fill(surface.row(y) + x0, surface.row(y) + x1, SurfaceId{0});
  }

  Plane<std::uint32_t> colour;  ///< RGBA8, alpha 0 where dark
  Plane<glm::vec2> place;       ///< in the picture, see TexelMap; undefined where dark
  Plane<SurfaceId> surface;     ///< 0 where dark
  Plane<std::uint16_t> shade;   ///< see shade_of(); undefined where dark
  std::vector<Span> lit;        ///< per row: everything outside this span is dark
};

}  // namespace handcast::renderer::cpu
