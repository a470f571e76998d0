// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "config/sections/projector.hpp"
#include "renderer/output/dither.hpp"

namespace handcast::renderer {

/// The thresholds of the bit planes (Dither), as values that the pixels are compared with. `Value`:
/// a level or a luminance, in which a pixel of each grey level has a value, given by `values`.
template <class Value>
class PlaneLimits {
 public:
  /// `values`: the value of each grey level 0..255, which do not fall.
  PlaneLimits(const config::Projector& settings, int planes, const std::array<Value, 256>& values);

  /// Computes the limits for a brightness that is multiplied by `fade`.
  void set_fade(double fade);
  /// The limits of a plane in the pixels (x + i, y), 0 <= i < kBlock, after which they repeat:
  /// pixels with a greater value are lit.
  const Value* row(int plane, int x, int y) const {
    const int mask = dither_.size() - 1;
    return limits_.data() + plane * to_next_plane() +
           static_cast<std::ptrdiff_t>(y & mask) * row_size() + (x & mask);
  }
  /// From a limit to that of the same pixel in the next plane.
  std::ptrdiff_t to_next_plane() const { return static_cast<std::ptrdiff_t>(size()) * row_size(); }
  /// Width and height of the pattern.
  int size() const { return dither_.size(); }
  /// Pixels from one row to the next: row() may start at each pixel of the pattern.
  int row_size() const { return kBlock + size(); }
  /// The pixels of row(), a multiple of the pattern's size: several vectors of the processor.
  static constexpr int kBlock = 64;

 private:
  /// The limits for the thresholds (i + 0.5) / count of the light, if the grey levels have `light`.
  std::vector<Value> limits_for(int count, std::span<const float> light) const;

  config::Projector settings_;
  Dither dither_;
  std::array<Value, 256> values_;
  std::vector<Value> limits_;
};

}  // namespace handcast::renderer
