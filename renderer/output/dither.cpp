// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/dither.hpp"

#include <utility>

namespace handcast::renderer {

/// The steps of i from plane to plane, without a common divisor with N: those with the least
/// flicker in `scripts/bench outputs`.
static constexpr int kStrideOf24 = 5, kStrideOf8 = 3;

Dither::Dither(int planes, Image<std::uint16_t> ranks)
    : planes_(planes), stride_(planes == 8 ? kStrideOf8 : kStrideOf24), ranks_(std::move(ranks)) {}

int Dither::at(int plane, int x, int y) const {
  // i and u come from two places of the pattern, so that they do not depend on each other.
  const int mask = size() - 1, far_x = size() / 2, far_y = size() / 4 + 1;
  const int start = ranks_.at(x & mask, y & mask) * planes_ / (size() * size());
  const int share = ranks_.at((x + far_x) & mask, (y + far_y) & mask);
  return (start + turn(plane)) % planes_ * size() * size() + share;
}

}  // namespace handcast::renderer
