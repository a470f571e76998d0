// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::renderer::cpu {

/// A wanted pixel and the way to its nearest seed.
struct NearestSeed {
  std::int16_t x, y;
  std::int8_t dx, dy;
  std::int16_t squared_px;  ///< dx^2 + dy^2
};

/// The nearest seed of every wanted pixel: exact, within a reach. After Meijster et al. 2000 in two
/// passes: up and down the columns, then along the rows outwards from each pixel, many pixels at
/// once, until no pixel can get a nearer seed. Of seeds equally near: the one in the nearer column,
/// then the left one, then the upper one.
class NearestPixel {
 public:
  static constexpr int kLargestReach = 32;

  /// `seeds` and `wanted` have one size; pixels are set where not 0. Work is done around the wanted
  /// pixels only. Row by row; wanted pixels without a seed within `reach_px` are left out. Valid
  /// until the next call.
  std::span<const NearestSeed> find(View<const std::uint8_t> seeds, View<const std::uint8_t> wanted,
                                    int reach_px);

 private:
  void sweep_columns(View<const std::uint8_t> seeds, Rect area);
  void scan_row(const std::uint8_t* wanted, int y, Rect wanted_area, int reach_px);

  std::vector<std::int8_t> to_seed_;  ///< per pixel of the area: rows to the nearest seed of its
                                      ///< column, -100 where too far
  std::vector<std::uint8_t> rows_below_;
  std::vector<std::int16_t> squares_;  ///< of one row of to_seed_, with room on both sides
  int to_seed_stride_ = 0;
  Rect area_;
  std::vector<NearestSeed> found_;
};

}  // namespace handcast::renderer::cpu
