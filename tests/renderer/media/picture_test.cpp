// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/picture.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "tests/scratch.hpp"

namespace handcast::renderer {
namespace {

using ::testing::HasSubstr;

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift & 255);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  const auto content = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + content +
         big_endian(static_cast<std::uint32_t>(sum));
}

std::string compressed(const std::string& raw) {
  std::vector<Bytef> bytes(compressBound(raw.size()));
  uLongf size = bytes.size();
  compress2(bytes.data(), &size, reinterpret_cast<const Bytef*>(raw.data()), raw.size(), 9);
  return {bytes.begin(), bytes.begin() + static_cast<long>(size)};
}

/// A grey picture of 5 x 3 px with the values 0, 1, 2, … in each row.
std::string picture(const std::string& extra, const std::string& surplus) {
  std::string rows;
  for (int y = 0; y < 3; ++y) rows += std::string("\0\0\1\2\3\4", 6);
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(5) + big_endian(3) + std::string("\x08\0\0\0\0", 5)) + extra +
         chunk("IDAT", compressed(rows + surplus)) + chunk("IEND", "");
}

/// A picture of one pixel, `depth` bits a channel.
std::string pixel(int depth, int colour_type, const std::string& extra, const std::string& data) {
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(1) + big_endian(1) + static_cast<char>(depth) +
                           static_cast<char>(colour_type) + std::string(3, '\0')) +
         extra + chunk("IDAT", compressed(std::string(1, '\0') + data)) + chunk("IEND", "");
}

class Png : public testing::Test {
 protected:
  Result<Image<std::uint8_t>> read(const std::string& bytes) const {
    const auto file = scratch_.path() / "picture.png";
    std::ofstream(file, std::ios::binary) << bytes;
    return read_grey_png(file);
  }
  test::Scratch scratch_;
};

TEST_F(Png, ChunksThatNoPixelNeedsAreLeftOut) {
  const auto read_back = read(picture(
      chunk("gAMA", big_endian(45455)) +
          chunk("zTXt", "Title" + std::string(2, '\0') + compressed("x")) + chunk("IDAT", ""),
      ""));
  ASSERT_TRUE(read_back) << read_back.error().what;
  for (int x = 0; x < 5; ++x) EXPECT_EQ(read_back->at(x, 2), x);
}

/// Together they would take 8 GB.
TEST_F(Png, TextsThatInflateToGigabytesAreLeftOut) {
  const auto text =
      chunk("zTXt", "k" + std::string(2, '\0') + compressed(std::string(7'900'000, 'a')));
  std::string texts;
  for (int i = 0; i < 999; ++i) texts += text;
  const auto image = read(picture(texts, ""));
  ASSERT_TRUE(image) << image.error().what;
  EXPECT_EQ(image->at(4, 2), 4);
}

TEST_F(Png, ImageDataBeyondTheLastPixelDoesNoHarm) {
  const auto image = read(picture("", std::string(50'000'000, '\0')));
  ASSERT_TRUE(image) << image.error().what;
  EXPECT_EQ(image->at(4, 2), 4);
}

TEST_F(Png, LevelsAreThoseOfTheScreenWhateverTheGammaOfTheFile) {
  const auto gamma = [](std::uint32_t times_100000) {
    return chunk("gAMA", big_endian(times_100000));
  };
  const auto level = [&](const std::string& bytes) { return int{read(bytes)->at(0, 0)}; };
  constexpr int kGrey = 0, kColour = 2, kPalette = 3, kGreyAlpha = 4;
  EXPECT_EQ(level(pixel(8, kGrey, "", "\x40")), 64);
  EXPECT_EQ(level(pixel(8, kGrey, gamma(45455), "\x40")), 64);
  EXPECT_EQ(level(pixel(8, kGrey, gamma(100000), "\x40")), 137);  // by the curve of sRGB
  EXPECT_EQ(level(pixel(8, kGrey, chunk("sRGB", "\1") + gamma(100000), "\x40")), 64);
  EXPECT_EQ(level(pixel(16, kGrey, "", "\x40\x40")), 137);
  EXPECT_EQ(level(pixel(16, kGrey, gamma(45455), "\x40\x40")), 64);
  EXPECT_EQ(level(pixel(1, kGrey, "", "\x80")), 255);
  EXPECT_EQ(level(pixel(8, kColour, "", "\x40\x40\x40")), 64);
  EXPECT_EQ(level(pixel(8, kColour, "", std::string("\0\xff\0", 3))), 220);  // 0.7152 of the light
  EXPECT_EQ(level(pixel(8, kPalette, chunk("PLTE", "\x10\x10\x10\x40\x40\x40"), "\1")), 64);
  EXPECT_EQ(level(pixel(8, kGreyAlpha, "", "\xff\x80")), 188);  // half of the light
}

TEST_F(Png, DamageIsLeftToTheDecoder) {
  const auto good = picture("", "");
  for (std::size_t size = 0; size + 16 < good.size(); ++size)
    EXPECT_FALSE(read(good.substr(0, size))) << size;
}

}  // namespace
}  // namespace handcast::renderer
