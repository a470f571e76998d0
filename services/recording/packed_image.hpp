// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/recording/deflate.hpp"

namespace handcast::recording {

/// Shape of an image: rows of pixels of 8-bit channels, without padding.
struct ImageShape {
  std::uint32_t width_px = 0, height_px = 0;
  std::uint32_t channels = 1;  ///< bytes per pixel: 1 (grey) or 4 (RGBA)

  std::size_t bytes() const { return std::size_t{width_px} * height_px * channels; }
  bool operator==(const ImageShape&) const = default;
};

/// Packs images without loss: RGBA becomes the planes red - green, green, blue - green and alpha;
/// each pixel becomes the difference from the one above it (both modulo 256); and the result is a
/// zlib stream. One thread.
class ImagePacker {
 public:
  /// Appends the packed image to `out`; `pixels` has shape.bytes() bytes.
  void append(std::span<const std::uint8_t> pixels, const ImageShape& shape, Bytes& out);

 private:
  std::vector<std::uint8_t> filtered_;
  Deflater deflater_;
};

/// Unpacks what ImagePacker has packed. One thread.
class ImageUnpacker {
 public:
  /// Fills `pixels`, shape.bytes() bytes. Returns false if the packed image is damaged.
  bool read(std::span<const std::byte> packed, const ImageShape& shape,
            std::span<std::uint8_t> pixels);

 private:
  std::vector<std::uint8_t> filtered_;
  Inflater inflater_;
};

}  // namespace handcast::recording
