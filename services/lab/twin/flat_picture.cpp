// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/flat_picture.hpp"

#include <fmt/format.h>

#include <cmath>

namespace handcast::twin {

Result<void> check(const FlatPicture& picture) {
  const bool has_pixels = picture.width_px > 0 && picture.height_px > 0 &&
                          picture.pixels.size() == static_cast<std::size_t>(picture.width_px) *
                                                       static_cast<std::size_t>(picture.height_px);
  if (!has_pixels)
    return fail(Errc::bad_data,
                fmt::format("twin: the picture of the board should have {} x {} pixels, but has {}",
                            picture.width_px, picture.height_px, picture.pixels.size()));
  const bool has_place = picture.metres_per_px > 0 && std::isfinite(picture.metres_per_px) &&
                         std::isfinite(picture.origin_px.x) && std::isfinite(picture.origin_px.y);
  if (!has_place)
    return fail(Errc::bad_data,
                fmt::format("twin: the picture of the board is of no use, with {} m per pixel and "
                            "its origin at ({}, {})",
                            picture.metres_per_px, picture.origin_px.x, picture.origin_px.y));
  return {};
}

}  // namespace handcast::twin
