// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// The coverage (0..255) of a line of text, in an image `height` pixels high, in which the parts of
/// letters below the line are cut off. In OpenCV's stroke font.
Image<std::uint8_t> lettering(const std::string& text, int height);
/// The same with the parts below the line, in an image that is so much higher.
Image<std::uint8_t> whole_lettering(const std::string& text, int height);

}  // namespace handcast::renderer
