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

/// Two pixels in three bytes, as GigE Vision packs them: the lowest bits of both in the middle.
std::vector<std::uint8_t> pair(const std::vector<int>& pixels, int bits) {
  std::vector<std::uint8_t> packed;
  for (std::size_t i = 0; i < pixels.size(); i += 2) {
    const int second = i + 1 < pixels.size() ? pixels[i + 1] : 0, low = bits - 8;
    const int mask = (1 << low) - 1;
    packed.push_back(static_cast<std::uint8_t>(pixels[i] >> low));
    packed.push_back(static_cast<std::uint8_t>((pixels[i] & mask) | (second & mask) << 4));
    packed.push_back(static_cast<std::uint8_t>(second >> low));
  }
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

TEST(PixelPairs, TheEightHighestBitsBecomeTheGreyImage) {
  for (const auto& [format, bits] :
       {std::pair{PixelFormat::mono10_packed, 10}, {PixelFormat::mono12_packed, 12}})
    for (const std::size_t count : {1, 2, 5, 8}) {
      std::vector<int> pixels;
      for (std::size_t i = 0; i < count; ++i)
        pixels.push_back(static_cast<int>((i * 1237 + 991) % (std::size_t{1} << bits)));
      auto packed = pair(pixels, bits);
      packed.resize(bytes_of(format, count));  // an odd last pixel has no third byte
      std::vector<std::uint8_t> grey(count);
      to_grey(format, packed, grey);
      for (std::size_t i = 0; i < count; ++i)
        EXPECT_EQ(grey[i], pixels[i] >> (bits - 8)) << bits << " bits, " << i << " of " << count;
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, Pixels,
                         testing::Values(Format{PixelFormat::mono8, 8, 8},
                                         Format{PixelFormat::mono10, 10, 16},
                                         Format{PixelFormat::mono12, 12, 16},
                                         Format{PixelFormat::mono10_p, 10, 10},
                                         Format{PixelFormat::mono12_p, 12, 12}));

}  // namespace
}  // namespace handcast::camera
