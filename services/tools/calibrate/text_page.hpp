// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::calibrate {

/// Fills a picture with text, white on black, in the middle: the first line larger, long ones
/// broken between words. Text that is still too much is drawn smaller.
void draw_text(const std::vector<std::string>& lines, renderer::Image<std::uint8_t>& picture);

}  // namespace handcast::calibrate
