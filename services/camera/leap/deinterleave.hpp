// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

namespace handcast::camera::leap {

/// Takes the image of one eye out of those of both. `eye`: 0 left, 1 right. `both` has twice as
/// many bytes as `image`.
void deinterleave(std::span<const std::uint8_t> both, std::size_t eye,
                  std::span<std::uint8_t> image);

}  // namespace handcast::camera::leap
