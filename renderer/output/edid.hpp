// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace handcast::renderer {

/// The name of a display in its EDID (VESA E-EDID 1.4, 3.10.3.4: descriptor 0xFC). Empty if it has
/// none, or if the block is damaged.
std::string model_of(std::span<const std::uint8_t> edid);

}  // namespace handcast::renderer
