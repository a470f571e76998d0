// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// The coverage (0..255) of a line of text, in an image `height` pixels high. In OpenCV's stroke
/// font.
Image<std::uint8_t> lettering(const std::string& text, int height);

}  // namespace handcast::renderer
