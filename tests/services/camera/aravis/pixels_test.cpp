// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/pixels.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace handcast::camera {
namespace {

using config::PixelFormat;

/// The pixels as a string of bits, lowest first, `bits` each.
std::vector<std::uint8_t> pack(const std::vector<int>& pixels, std::size_t bits) {
  std::vector<std::uint8_t> packed((pixels.size() * bits + 7) / 8);
  for (std::size_t i = 0; i < pixels.size() * bits; ++i)
    if (pixels[i / bits] >> (i % bits) & 1)
      packed[i / 8] = static_cast<std::uint8_t>(packed[i / 8] | 1 << (i % 8));
  return packed;
}

struct Format {
  PixelFormat format;
  std::size_t bits, sent_bits;
};

class Pixels : public testing::TestWithParam<Format> {};

TEST_P(Pixels, TheEightHighestBitsBecomeTheGreyImage) {
  const auto [format, bits, sent_bits] = GetParam();
  // Numbers of pixels that do not fill the last group of bytes, too.
  for (std::size_t count = 1; count < 20; ++count) {
    std::vector<int> pixels;
    for (std::size_t i = 0; i < count; ++i)
      pixels.push_back(static_cast<int>((i * 1237 + 991) % (std::size_t{1} << bits)));
    const auto packed = pack(pixels, sent_bits);
    ASSERT_EQ(bytes_of(format, count), packed.size());
    std::vector<std::uint8_t> grey(count);
    to_grey(format, packed, grey);
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_EQ(grey[i], pixels[i] >> (bits - 8)) << i << " of " << count;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Pixels,
                         testing::Values(Format{PixelFormat::mono8, 8, 8},
                                         Format{PixelFormat::mono10, 10, 16},
                                         Format{PixelFormat::mono12, 12, 16},
                                         Format{PixelFormat::mono10_packed, 10, 10},
                                         Format{PixelFormat::mono12_packed, 12, 12}));

}  // namespace
}  // namespace handcast::camera
