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

/// What the fill needs to know of a distance, by its square in px. All painters fill by this table.
struct FillTable {
  /// Size of the tables: one more than the square of the largest reach.
  static constexpr int kSquares = NearestPixel::kLargestReach * NearestPixel::kLargestReach + 1;

  /// Computes the table for these settings. Returns false if it already is that of these settings.
  bool set_up(const config::Fill& settings);

  int reach_px = 0;                                ///< of the settings
  std::array<std::uint16_t, kSquares> strength{};  ///< of the light of a fill, 0..256
  /// The square of the longest step in texture coordinates over a reflection that does not cross a
  /// seam. The step is seam_uv up to 8 px and grows in proportion beyond, as the steps on a smooth
  /// surface do.
  std::array<float, kSquares> squared_limit_uv{};

 private:
  double fade_px_ = 0, seam_uv_ = 0;
};

}  // namespace handcast::renderer::cpu
