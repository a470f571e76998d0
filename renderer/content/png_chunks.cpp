// SPDX-License-Identifier: Apache-2.0
// The format: PNG specification, third edition, sections 5.3 (chunks), 8.1 (interlacing) and 11.2.1
// (IHDR).
#include "renderer/content/png_chunks.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace handcast::renderer {
namespace {

constexpr std::size_t kSignature = 8, kAroundData = 12;  // of a chunk: length, type, checksum
constexpr std::array<std::string_view, 8> kNeeded{"IHDR", "PLTE", "tRNS", "gAMA",
                                                  "cHRM", "sRGB", "IDAT", "IEND"};

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

/// Calls `visit(type, data, whole)` for each whole chunk of a file.
template <class Visit>
void each_chunk(std::string_view file, Visit&& visit) {
  std::size_t at = kSignature;
  while (at < file.size() && file.size() - at >= kAroundData) {
    const std::size_t length = number_at(file, at);
    if (length > file.size() - at - kAroundData) return;
    visit(file.substr(at + 4, 4), file.substr(at + 8, length),
          file.substr(at, length + kAroundData));
    at += length + kAroundData;
  }
}

/// Bytes of the filtered rows of one image, or of one pass of an interlaced one.
std::uint64_t bytes_of_rows(std::uint64_t width, std::uint64_t height, std::uint64_t pixel_bits) {
  return width == 0 || height == 0 ? 0 : height * (1 + (width * pixel_bits + 7) / 8);
}

/// Bytes of the image data before compression. Empty if the header is malformed, or the picture
/// larger than any that is read.
std::optional<std::uint64_t> bytes_of_image(std::string_view header) {
  if (header.size() != 13) return std::nullopt;
  const std::uint64_t width = number_at(header, 0), height = number_at(header, 4);
  if (width > kLargestSide || height > kLargestSide) return std::nullopt;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(header[i]); };
  constexpr std::array<std::uint64_t, 7> kChannels{1, 0, 3, 1, 2, 0, 4};  // by colour type
  if (byte(9) >= kChannels.size() || byte(8) > 16) return std::nullopt;
  const std::uint64_t bits = byte(8) * kChannels[byte(9)];
  if (byte(12) == 0) return bytes_of_rows(width, height, bits);
  struct Pass {
    std::uint64_t x, y, step_x, step_y;
  };
  constexpr std::array<Pass, 7> kPasses{{{0, 0, 8, 8},
                                         {4, 0, 8, 8},
                                         {0, 4, 4, 8},
                                         {2, 0, 4, 4},
                                         {0, 2, 2, 4},
                                         {1, 0, 2, 2},
                                         {0, 1, 1, 2}}};
  std::uint64_t bytes = 0;
  for (const auto& pass : kPasses)
    bytes +=
        bytes_of_rows((width - std::min(pass.x, width) + pass.step_x - 1) / pass.step_x,
                      (height - std::min(pass.y, height) + pass.step_y - 1) / pass.step_y, bits);
  return bytes;
}

/// Counts the bytes that image data inflates to.
class Inflation {
 public:
  Inflation() : out_(kPart) { is_well_ = inflateInit(&stream_) == Z_OK; }
  ~Inflation() { inflateEnd(&stream_); }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;

  /// Adds a part of the data; stops above `most` bytes.
  void add(std::string_view data, std::uint64_t most) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
    stream_.avail_in = static_cast<uInt>(data.size());
    while (is_well_ && stream_.avail_in > 0 && count_ <= most) {
      stream_.next_out = out_.data();
      stream_.avail_out = kPart;
      is_well_ = inflate(&stream_, Z_NO_FLUSH) == Z_OK;  // false at its end, too
      count_ += kPart - stream_.avail_out;
    }
  }
  std::uint64_t count() const { return count_; }

 private:
  static constexpr uInt kPart = 1 << 16;
  z_stream stream_{};
  std::vector<Bytef> out_;
  std::uint64_t count_ = 0;
  bool is_well_ = false;
};

}  // namespace

PlainPng plain_png(std::string_view file) {
  constexpr std::uint64_t kSlack = 1 << 16;  // what libpng inflates at the end without effort
  PlainPng plain{std::string(file.substr(0, kSignature)), {}};
  std::optional<std::uint64_t> expected;
  Inflation inflation;
  each_chunk(file, [&](std::string_view type, std::string_view data, std::string_view whole) {
    if (std::ranges::find(kNeeded, type) == kNeeded.end()) return;
    if (type == "IHDR" && !expected) expected = bytes_of_image(data);  // libpng reads one
    if (type == "IDAT" && data.empty()) return;
    if (type == "IDAT" && expected) {
      inflation.add(data, *expected + kSlack);
      if (inflation.count() > *expected + kSlack) plain.fault = "has more image data than pixels";
    }
    plain.bytes += whole;
  });
  return plain;
}

}  // namespace handcast::renderer
