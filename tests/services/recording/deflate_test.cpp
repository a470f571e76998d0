// SPDX-License-Identifier: Apache-2.0
// Streams of the Deflater, decompressed by zlib, which any reader may use.
#include "services/recording/deflate.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <random>

#include "services/recording/packed_image.hpp"

namespace handcast::recording {
namespace {

using Pixels = std::vector<std::uint8_t>;

Bytes deflated(const Pixels& bytes) {
  Bytes stream;
  Deflater().append(bytes, stream);
  return stream;
}

/// What zlib makes of the stream; empty if it refuses it.
Pixels inflated_by_zlib(const Bytes& stream, std::size_t size) {
  Pixels bytes(size + 1);
  uLongf length = bytes.size();
  if (::uncompress(bytes.data(), &length, reinterpret_cast<const Bytef*>(stream.data()),
                   stream.size()) != Z_OK)
    return {};
  bytes.resize(length);
  return bytes;
}

void expect_round_trip(const Pixels& bytes) {
  const auto stream = deflated(bytes);
  EXPECT_EQ(inflated_by_zlib(stream, bytes.size()), bytes) << bytes.size() << " bytes";
  Pixels again(bytes.size());
  EXPECT_TRUE(Inflater().read(stream, again));
  EXPECT_EQ(again, bytes);
}

TEST(Deflate, EveryKindOfBytesComesBack) {
  std::mt19937 dice(1);
  for (const std::size_t size : {0, 1, 2, 3, 4, 5, 257, 258, 259, 260, 261, 516, 5000}) {
    expect_round_trip(Pixels(size));
    expect_round_trip(Pixels(size, 255));
    for (const unsigned most : {1u, 2u, 5u, 255u}) {
      Pixels noise(size);
      for (auto& byte : noise) byte = static_cast<std::uint8_t>(dice() % (most + 1));
      expect_round_trip(noise);
    }
  }
}

TEST(Deflate, EveryLengthOfARunComesBack) {
  for (std::size_t length = 1; length < 600; ++length) {
    Pixels run(length + 2, 7);
    run.front() = 1;
    run.back() = 2;
    expect_round_trip(run);
  }
}

/// Symbols as rare as the Fibonacci numbers would get codes of more than 15 bits.
TEST(Deflate, CodesThatWouldBeTooLongAreShortened) {
  Pixels bytes;
  std::size_t count = 1, before = 1;
  for (int symbol = 0; symbol < 25; ++symbol) {
    bytes.insert(bytes.end(), count, static_cast<std::uint8_t>(3 * symbol));
    before = std::exchange(count, count + before);
  }
  std::shuffle(bytes.begin(), bytes.end(), std::mt19937(2));
  expect_round_trip(bytes);
}

TEST(Deflate, ADarkNoisyImageTakesLittleMoreThanItsEntropy) {
  std::mt19937 dice(3);
  std::normal_distribution<float> grey(9, 2);
  Pixels noise(200'000);
  for (auto& pixel : noise) pixel = static_cast<std::uint8_t>(grey(dice));
  EXPECT_LT(8.0 * static_cast<double>(deflated(noise).size()) / 200'000, 3.05 * 1.03);
}

TEST(Deflate, ADamagedStreamIsRefused) {
  const Pixels bytes(1000, 3);
  auto stream = deflated(bytes);
  Pixels out(1000);
  EXPECT_FALSE(Inflater().read(std::span(stream).first(stream.size() - 1), out));
  Pixels larger(1001), smaller(999);
  EXPECT_FALSE(Inflater().read(stream, larger));
  EXPECT_FALSE(Inflater().read(stream, smaller));
  stream.back() ^= std::byte{1};
  EXPECT_FALSE(Inflater().read(stream, out)) << "the checksum";
}

TEST(PackedImage, ImagesOfAllShapesComeBack) {
  std::mt19937 dice(4);
  for (const auto& shape : {ImageShape{1, 1, 1},
                            {1, 9, 1},
                            {9, 1, 1},
                            {13, 7, 1},
                            {1, 1, 4},
                            {13, 7, 4},
                            {1, 9, 4},
                            {9, 1, 4}}) {
    Pixels image(shape.bytes());
    for (auto& byte : image) byte = static_cast<std::uint8_t>(dice());
    Bytes packed;
    ImagePacker packer;
    packer.append(image, shape, packed);
    Pixels again(image.size());
    EXPECT_TRUE(ImageUnpacker().read(packed, shape, again));
    EXPECT_EQ(again, image) << shape.width_px << " x " << shape.height_px;
  }
}

}  // namespace
}  // namespace handcast::recording
