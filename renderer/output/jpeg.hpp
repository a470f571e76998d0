// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// A picture (RGBA8, alpha is left out) as a JPEG file, with all its colour and little loss.
std::vector<std::uint8_t> jpeg_of(View<const std::uint32_t> picture);

}  // namespace handcast::renderer
