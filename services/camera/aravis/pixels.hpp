// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "config/sections/sensors.hpp"

namespace handcast::camera {

/// Number of bytes of `pixels` pixels in a format of a GenICam camera.
std::size_t bytes_of(config::PixelFormat format, std::size_t pixels);

/// Writes the 8 highest bits of each pixel to `grey`. `packed` has bytes_of(format, grey.size())
/// bytes. Mono10 and Mono12 have 16 bits, little-endian; Mono10p and Mono12p are strings of bits,
/// lowest first (GenICam Pixel Format Naming Convention 2.1). Mono10Packed and Mono12Packed have
/// the highest bits of two pixels around a byte with their lowest (GigE Vision 2.0, section 26.2).
void to_grey(config::PixelFormat format, std::span<const std::uint8_t> packed,
             std::span<std::uint8_t> grey);

}  // namespace handcast::camera
