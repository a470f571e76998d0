// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::renderer::cpu {

/// A wanted pixel and the vector to its nearest seed, in pixels.
struct NearestSeed {
  /// The wanted pixel.
  /// @{
  std::int16_t x, y;
  /// @}
  /// From there to the seed.
  /// @{
  std::int8_t dx, dy;
  /// @}
  std::int16_t squared_px;  ///< dx^2 + dy^2
};

/// Finds the nearest seed of every wanted pixel, exactly, within a reach. Two passes, after
/// Meijster et al. 2000: up and down the columns, then along the rows outwards from each pixel,
/// many pixels at once, until no pixel can get a nearer seed. Among seeds at the same distance, the
/// one in the nearer column is taken, then the left one, then the upper one. One thread.
class NearestPixel {
 public:
  /// Limit of `reach_px`.
  static constexpr int kLargestReach = 32;

  /// Allocates nothing later for images of at most this size.
  explicit NearestPixel(int width = 0, int height = 0);

  /// Begins a search. `seeds` and `wanted` have the same size; pixels that are not 0 are set. Only
  /// `bounds`, which contain all wanted pixels, and what is near them are processed. Both images
  /// must stay until the last of_row().
  void start(View<const std::uint8_t> seeds, View<const std::uint8_t> wanted, Rect bounds,
             int reach_px);
  /// The wanted pixels of a row of the bounds, without those that have no seed within the reach.
  /// Valid until the next call.
  std::span<const NearestSeed> of_row(int y);
  /// The same of all rows, from a search of its own. Valid until the next call.
  std::span<const NearestSeed> find(View<const std::uint8_t> seeds, View<const std::uint8_t> wanted,
                                    int reach_px);

 private:
  void sweep_columns(View<const std::uint8_t> seeds, Rect area);

  /// Per pixel of area_: rows to the nearest seed in its column, -100 if that is too far.
  std::vector<std::int8_t> to_seed_;
  std::vector<std::uint8_t> rows_below_;
  std::vector<std::int16_t> squares_;  ///< of one row of to_seed_, with a margin on both sides
  int to_seed_stride_ = 0;
  Rect area_, wanted_area_;
  View<const std::uint8_t> wanted_;
  int reach_px_ = 0;
  std::vector<NearestSeed> row_;  ///< has room for a whole row
  std::vector<NearestSeed> all_;  ///< of find()
};

}  // namespace handcast::renderer::cpu
