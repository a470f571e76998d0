// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace handcast::camera::leap {

/// Numbers in bytes, lowest byte first, as USB and the controller have them. The bytes must be
/// there.
/// @{
inline std::uint16_t get_16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}
inline std::uint32_t get_32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return get_16(bytes, at) | static_cast<std::uint32_t>(get_16(bytes, at + 2)) << 16;
}
inline float get_float(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::bit_cast<float>(get_32(bytes, at));
}
inline void put_16(std::span<std::uint8_t> bytes, std::size_t at, std::uint32_t number) {
  bytes[at] = static_cast<std::uint8_t>(number);
  bytes[at + 1] = static_cast<std::uint8_t>(number >> 8);
}
inline void put_32(std::span<std::uint8_t> bytes, std::size_t at, std::uint32_t number) {
  put_16(bytes, at, number);
  put_16(bytes, at + 2, number >> 16);
}
/// @}

}  // namespace handcast::camera::leap
