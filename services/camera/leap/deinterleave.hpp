// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

namespace handcast::camera::leap {

/// Takes the image of one eye, `width_px` wide, out of those of both. `eye`: 0 left, 1 right.
/// `both` has two bytes for each pixel of the sensor. If `image` has k times as many rows, each row
/// of the sensor is taken for the mean of k rows: it lies in the middle of them, and those in
/// between are interpolated. So the pixels of 640x240, which are twice as high as wide, become
/// square.
void deinterleave(std::span<const std::uint8_t> both, std::size_t eye, int width_px,
                  std::span<std::uint8_t> image);

}  // namespace handcast::camera::leap
