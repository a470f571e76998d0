// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::twin {

/// The picture on a flat board, row by row from the top; its edge is the edge of the board. The
/// board's axes: x to the picture's right, y down, z into the board, in metres.
struct FlatPicture {
  /// Size in pixels.
  /// @{
  int width_px = 0;
  int height_px = 0;
  /// @}
  std::vector<std::uint8_t> pixels;  ///< reflectance: 0 black to 255 white paper
  double metres_per_px = 0;
  /// Where the board's (0, 0) is in the picture; (0, 0) is the centre of the top-left pixel.
  glm::dvec2 origin_px{0};

  /// The place of a position in the picture on the board, m.
  glm::dvec2 on_board_m(const glm::dvec2& px) const { return (px - origin_px) * metres_per_px; }
};

/// Errors: bad_data (no pixels, another number of them than the size says, no scale, or no origin).
Result<void> check(const FlatPicture& picture);

/// What the projector shows: grey, row by row from the top, without padding. Borrowed.
struct Light {
  const std::uint8_t* grey = nullptr;  ///< share of the full light, linear: 0 dark to 255; not null
  /// Size in pixels: that of the projector's image.
  /// @{
  int width_px = 0;
  int height_px = 0;
  /// @}
};

}  // namespace handcast::twin
