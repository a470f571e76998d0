// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/fill_table.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/base/srgb.hpp"

namespace handcast::renderer::cpu {

ShareTable share_table() {
  ShareTable table{};
  for (std::size_t share = 0; share < table.size(); ++share)
    table[share] =
        static_cast<std::uint16_t>(std::lround(256 * srgb_level(static_cast<double>(share) / 255)));
  return table;
}

bool FillTable::set_up(const config::Fill& settings) {
  if (reach_px == settings.reach_px && fade_px_ == settings.fade_px && seam_uv_ == settings.seam_uv)
    return false;
  reach_px = settings.reach_px;
  fade_px_ = settings.fade_px;
  seam_uv_ = settings.seam_uv;
  for (int square = 0; square < kSquares; ++square) {
    const double length_px = std::sqrt(square), left_px = reach_px - length_px;
    const double part = fade_px_ > 0   ? std::clamp(left_px / fade_px_, 0.0, 1.0)
                        : left_px >= 0 ? 1.0
                                       : 0.0;
    const auto limit_uv = static_cast<float>(seam_uv_ * std::max(1.0, length_px / 8));
    strength[square] = static_cast<std::uint16_t>(std::lround(256 * part));
    alpha[square] = static_cast<std::uint8_t>(std::lround(1 + 254 * srgb_light(part)));
    squared_limit_uv[square] = limit_uv * limit_uv;
  }
  return true;
}

}  // namespace handcast::renderer::cpu
