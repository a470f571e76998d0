// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/pixels.hpp"

#include <algorithm>

namespace handcast::camera {
namespace {

using config::PixelFormat;

std::size_t bits_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::mono8:
      return 8;
    case PixelFormat::mono10_p:
      return 10;
    case PixelFormat::mono12_p:
    case PixelFormat::mono10_packed:
    case PixelFormat::mono12_packed:
      return 12;
    case PixelFormat::mono10:
    case PixelFormat::mono12:
      return 16;
  }
  return 8;
}

/// `Shift`: the lowest of the 8 highest bits.
template <int Shift>
void from_16_bits(std::span<const std::uint8_t> packed, std::span<std::uint8_t> grey) {
  for (std::size_t i = 0; i < grey.size(); ++i)
    grey[i] = static_cast<std::uint8_t>(packed[2 * i] >> Shift | packed[2 * i + 1] << (8 - Shift));
}

/// The 8 bits from `bit` on in a string of bits, lowest first.
std::uint8_t byte_at(std::span<const std::uint8_t> packed, std::size_t bit) {
  const std::size_t at = bit / 8, shift = bit % 8;
  if (shift == 0) return packed[at];
  return static_cast<std::uint8_t>(packed[at] >> shift | packed[at + 1] << (8 - shift));
}

/// Four pixels are five bytes.
void from_10_bits(std::span<const std::uint8_t> packed, std::span<std::uint8_t> grey) {
  std::size_t i = 0;
  const std::uint8_t* from = packed.data();
  for (; i + 4 <= grey.size(); i += 4, from += 5) {
    grey[i] = static_cast<std::uint8_t>(from[0] >> 2 | from[1] << 6);
    grey[i + 1] = static_cast<std::uint8_t>(from[1] >> 4 | from[2] << 4);
    grey[i + 2] = static_cast<std::uint8_t>(from[2] >> 6 | from[3] << 2);
    grey[i + 3] = from[4];
  }
  for (; i < grey.size(); ++i) grey[i] = byte_at(packed, 10 * i + 2);
}

/// Two pixels are three bytes.
void from_12_bits(std::span<const std::uint8_t> packed, std::span<std::uint8_t> grey) {
  std::size_t i = 0;
  const std::uint8_t* from = packed.data();
  for (; i + 2 <= grey.size(); i += 2, from += 3) {
    grey[i] = static_cast<std::uint8_t>(from[0] >> 4 | from[1] << 4);
    grey[i + 1] = from[2];
  }
  for (; i < grey.size(); ++i) grey[i] = byte_at(packed, 12 * i + 4);
}

/// Two pixels are three bytes: the 8 highest bits of each, and between them the lowest of both.
void from_pairs(std::span<const std::uint8_t> packed, std::span<std::uint8_t> grey) {
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = packed[i / 2 * 3 + i % 2 * 2];
}

}  // namespace

std::size_t bytes_of(PixelFormat format, std::size_t pixels) {
  return (pixels * bits_of(format) + 7) / 8;
}

void to_grey(PixelFormat format, std::span<const std::uint8_t> packed,
             std::span<std::uint8_t> grey) {
  switch (format) {
    case PixelFormat::mono8:
      std::ranges::copy(packed.first(grey.size()), grey.begin());
      break;
    case PixelFormat::mono10:
      from_16_bits<2>(packed, grey);
      break;
    case PixelFormat::mono12:
      from_16_bits<4>(packed, grey);
      break;
    case PixelFormat::mono10_p:
      from_10_bits(packed, grey);
      break;
    case PixelFormat::mono12_p:
      from_12_bits(packed, grey);
      break;
    case PixelFormat::mono10_packed:
    case PixelFormat::mono12_packed:
      from_pairs(packed, grey);
      break;
  }
}

}  // namespace handcast::camera
