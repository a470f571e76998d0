// SPDX-License-Identifier: Apache-2.0
#include "renderer/content/png_chunks.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "renderer/content/picture.hpp"
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

/// The same with a bomb, and with a header of a large picture behind it.
std::string picture_with_second_header() {
  auto bytes = picture("", std::string(50'000'000, '\0'));
  const auto end = chunk("IEND", "");
  bytes.resize(bytes.size() - end.size());
  return bytes +
         chunk("IHDR", big_endian(8192) + big_endian(8192) + std::string("\x08\2\0\0\0", 5)) + end;
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

TEST_F(Png, ASecondHeaderDoesNotRaiseTheLimitOfTheImageData) {
  const auto image = read(picture_with_second_header());
  ASSERT_FALSE(image);
  EXPECT_THAT(image.error().what, HasSubstr("more image data than pixels"));
}

TEST_F(Png, ChunksThatNoPixelNeedsAreLeftOut) {
  const auto with = picture(chunk("gAMA", big_endian(45455)) +
                                chunk("zTXt", "Title" + std::string(2, '\0') + compressed("x")) +
                                chunk("IDAT", ""),
                            "");
  EXPECT_EQ(plain_png(with).bytes, picture(chunk("gAMA", big_endian(45455)), ""));
  const auto read_back = read(with);
  ASSERT_TRUE(read_back) << read_back.error().what;
  for (int x = 0; x < 5; ++x) EXPECT_EQ(read_back->at(x, 2), x);
}

/// libpng would inflate each of these texts and keep it: 8 GB.
TEST_F(Png, TextsThatInflateToGigabytesAreNotInflated) {
  const auto text =
      chunk("zTXt", "k" + std::string(2, '\0') + compressed(std::string(7'900'000, 'a')));
  std::string texts;
  for (int i = 0; i < 999; ++i) texts += text;
  EXPECT_EQ(plain_png(picture(texts, "")).bytes, picture("", ""));
}

TEST_F(Png, ImageDataBeyondTheLastPixelIsRefused) {
  EXPECT_TRUE(read(picture("", "a few bytes do no harm")));
  const auto refused = read(picture("", std::string(10'000'000, '\0')));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("picture.png' has more image data than pixels"));
}

TEST_F(Png, DamageIsLeftToTheDecoder) {
  const auto good = picture("", "");
  for (std::size_t size = 0; size + 16 < good.size(); ++size)
    EXPECT_FALSE(read(good.substr(0, size))) << size;
}

}  // namespace
}  // namespace handcast::renderer
