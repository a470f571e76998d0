// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// Black-on-nothing lettering as coverage (0..255), trimmed to a box `height` pixels high. By
/// OpenCV's strokes.
Image<std::uint8_t> lettering(const std::string& text, int height);

}  // namespace handcast::renderer
