// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_decompressor;

namespace handcast::recording {

using Bytes = std::vector<std::byte>;

/// Compresses bytes to a zlib stream (RFC 1950) of one block with a Huffman code of its own, in
/// which only runs of equal bytes are matched. Made for filtered images, where longer matches are
/// rare: several times as fast as zlib's fastest level. One thread.
class Deflater {
 public:
  /// Appends the stream of `bytes` to `out`.
  void append(std::span<const std::uint8_t> bytes, Bytes& out);

 private:
  std::vector<std::uint16_t> tokens_;
  Bytes stream_;
};

/// Decompresses any zlib stream whose size is known. One thread.
class Inflater {
 public:
  Inflater();

  /// Fills `bytes`. Returns false if the stream is damaged or does not give exactly as many.
  bool read(std::span<const std::byte> stream, std::span<std::uint8_t> bytes);

 private:
  struct Free {
    void operator()(libdeflate_decompressor* decompressor) const;
  };
  std::unique_ptr<libdeflate_decompressor, Free> decompressor_;
};

}  // namespace handcast::recording
