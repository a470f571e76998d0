// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/packing.hpp"

#include <algorithm>

#include "renderer/output/packers.hpp"

namespace handcast::renderer {

static constexpr std::uint32_t kDark = 0xff000000u;

Packer::Packer(int width_px, int height_px, int parts)
    : image_(width_px, height_px, kDark), lit_(static_cast<std::size_t>(parts)) {}

void Packer::begin(double fade) {
  for (Rect& lit : lit_) {
    for (int y = lit.y0; y < lit.y1; ++y)
      std::fill(image_.row(y) + lit.x0, image_.row(y) + lit.x1, kDark);
    lit = {};
  }
  if (fade != fade_) set_fade(fade_ = fade);
}

Rect Packer::region() const {
  Rect all;
  for (const Rect& lit : lit_) all = all.joined(lit);
  return all;
}

std::unique_ptr<Packer> make_packer(const config::Projector& settings, int width_px,
                                    int height_px) {
  switch (settings.packing) {
    case config::Packing::planes_24x1:
      return make_grey_plane_packer(settings, width_px, height_px);
    case config::Packing::planes_8x3:
      return make_colour_plane_packer(settings, width_px, height_px);
    case config::Packing::quadrants_4:
    case config::Packing::quadrants_12:
      return make_quadrant_packer(settings, width_px, height_px);
    case config::Packing::none:
      break;
  }
  return nullptr;
}

}  // namespace handcast::renderer
