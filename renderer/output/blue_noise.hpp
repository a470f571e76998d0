// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// Width and height of a dither pattern, which repeats over an image.
inline constexpr int kPatternSize = 64;
/// Number of pixels of a dither pattern.
inline constexpr int kPatternPixels = kPatternSize * kPatternSize;

/// Blue noise: each number 0..kPatternPixels - 1 once, so that the pixels with numbers less than n
/// are spread evenly for every n. By void and cluster: Ulichney 1993, "The void-and-cluster method
/// for dither array generation", with its filter of 1.5 px. Always the same pattern; takes about 20
/// ms.
Image<std::uint16_t> blue_noise();

}  // namespace handcast::renderer
