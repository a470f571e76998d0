// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace handcast::calib {

/// A grey image that belongs to somebody else: `height_px` rows of `width_px` bytes, `stride` bytes
/// apart.
struct GreyView {
  const std::uint8_t* pixels = nullptr;
  int width_px = 0, height_px = 0;
  std::ptrdiff_t stride = 0;
};

/// A grey image: rows from the top, without gaps.
struct GreyPicture {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> pixels;

  GreyView view() const { return {pixels.data(), width_px, height_px, width_px}; }
};

}  // namespace handcast::calib
