// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "config/sections/cascade.hpp"
#include "renderer/draw/cpu/nearest_pixel.hpp"

namespace handcast::renderer::cpu {

/// The factor (0..256) of a pixel's levels for the share (0..255) of the pixel that is hand: the
/// light is proportional to the share.
using ShareTable = std::array<std::uint16_t, 256>;
/// The table of all painters.
ShareTable share_table();

/// The alpha of a pixel that is hand in part: `mask` of the alpha 1..255 that it has.
constexpr std::uint32_t alpha_in_part(std::uint32_t alpha, std::uint32_t mask) {
  const std::uint32_t product = alpha * mask / 255;
  return product > 0 ? product : 1;
}

/// What the fill needs to know of a distance, by its square in px. All painters fill by this table.
struct FillTable {
  /// Size of the tables: one more than the square of the largest reach.
  static constexpr int kSquares = NearestPixel::kLargestReach * NearestPixel::kLargestReach + 1;

  /// Computes the table for these settings. Returns false if it already is that of these settings.
  bool set_up(const config::Fill& settings);

  int reach_px = 0;                                ///< of the settings
  std::array<std::uint16_t, kSquares> strength{};  ///< of the levels of a fill, 0..256
  std::array<std::uint8_t, kSquares> alpha{};      ///< of a fill: that share of the light, 1..255
  /// The square of the longest step in texture coordinates over a reflection that does not cross a
  /// seam. The step is seam_uv up to 8 px and grows in proportion beyond, as the steps on a smooth
  /// surface do.
  std::array<float, kSquares> squared_limit_uv{};

 private:
  double fade_px_ = 0, seam_uv_ = 0;
};

}  // namespace handcast::renderer::cpu
