// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace handcast::calib {

/// A grey image that someone else owns.
struct GreyView {
  const std::uint8_t* pixels = nullptr;  ///< the rows from top to bottom, each from left to right
  int width_px = 0, height_px = 0;
  std::ptrdiff_t stride = 0;  ///< bytes from one row to the next
};

}  // namespace handcast::calib
