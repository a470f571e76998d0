// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/picture.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "renderer/media/jpeg.hpp"
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

using Primaries = std::array<std::array<double, 3>, 3>;

/// An ICC profile whose values are light: the primaries of red, green and blue in XYZ.
std::string linear_profile(const std::string& colours,
                           const Primaries& primaries = {{{0.43607, 0.22250, 0.01393},
                                                          {0.38506, 0.71688, 0.09710},
                                                          {0.14308, 0.06062, 0.71417}}}) {
  const std::string curve = "curv" + std::string(8, '\0');  // no entries: the identity
  const std::string name =
      "desc" + big_endian(0) + big_endian(13) + std::string("A linear one\0", 13);
  std::vector<std::pair<std::string, std::string>> tags{{"desc", name}};
  for (const std::string tag : {"rTRC", "gTRC", "bTRC", "kTRC"}) tags.emplace_back(tag, curve);
  for (std::size_t k = 0; k < 3; ++k) {
    std::string xyz = "XYZ " + big_endian(0);
    for (const double part : primaries[k])
      xyz += big_endian(static_cast<std::uint32_t>(std::lround(65536 * part)));
    tags.emplace_back(std::string(1, "rgb"[k]) + "XYZ", xyz);
  }
  std::string table = big_endian(static_cast<std::uint32_t>(tags.size())), data;
  const auto first = 128 + 4 + 12 * tags.size();
  for (const auto& [tag, content] : tags) {
    table += tag + big_endian(static_cast<std::uint32_t>(first + data.size())) +
             big_endian(static_cast<std::uint32_t>(content.size()));
    data += content;
  }
  return std::string(16, '\0') + colours + "XYZ " + std::string(12, '\0') + "acsp" +
         std::string(88, '\0') + table + data;
}

std::string icc_chunk(const std::string& profile) {
  return chunk("iCCP", "name" + std::string(2, '\0') + compressed(profile));
}

/// An Exif block that says an orientation.
std::string exif(int orientation, bool big) {
  const auto value = static_cast<char>(orientation);
  if (big)
    return std::string("MM\0*\0\0\0\x08\0\1\1\x12\0\3\0\0\0\1\0", 19) + value +
           std::string(6, '\0');
  return std::string("II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0", 18) + value + std::string(7, '\0');
}

class Png : public testing::Test {
 protected:
  void write(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }
  Result<Image<std::uint8_t>> read(const std::string& bytes) const {
    write(bytes);
    return read_camera_picture(file_).map([](auto&& read) { return std::move(read.grey); });
  }
  test::Scratch scratch_;
  std::filesystem::path file_ = scratch_.path() / "picture.png";
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

constexpr int kGrey = 0, kColour = 2, kPalette = 3, kGreyAlpha = 4, kColourAlpha = 6;

std::string gamma(std::uint32_t times_100000) { return chunk("gAMA", big_endian(times_100000)); }

TEST_F(Png, ImagesOfACameraAreDataWhateverTheirChunksSay) {
  const auto value = [&](const std::string& bytes) { return int{read(bytes)->at(0, 0)}; };
  EXPECT_EQ(value(pixel(8, kGrey, "", "\x40")), 64);
  EXPECT_EQ(value(pixel(8, kGrey, gamma(100000), "\x40")), 64);
  EXPECT_EQ(value(pixel(8, kGrey, chunk("sRGB", "\1") + gamma(100000), "\x40")), 64);
  EXPECT_EQ(value(pixel(8, kGrey, icc_chunk(linear_profile("RGB ")), "\x40")), 64);
  EXPECT_EQ(value(pixel(16, kGrey, "", "\x40\x40")), 64);
  EXPECT_EQ(value(pixel(16, kGrey, gamma(100000), std::string("\x40\0", 2))), 64);
  EXPECT_EQ(value(pixel(1, kGrey, "", "\x80")), 255);
  EXPECT_EQ(value(pixel(8, kColour, "", "\x40\x40\x40")), 64);
  EXPECT_EQ(value(pixel(8, kColour, "", std::string("\0\xff\0", 3))), 150);  // luma
  EXPECT_EQ(value(pixel(8, kPalette, chunk("PLTE", "\x10\x10\x10\x40\x40\x40"), "\1")), 64);
  EXPECT_EQ(value(pixel(8, kGreyAlpha, "", "\xff\x80")), 128);
  EXPECT_EQ(value(pixel(8, kGrey, chunk("tRNS", std::string("\0\x40", 2)), "\x40")), 0);
}

TEST_F(Png, TheBitsThatACameraUsesAreThoseOfItsLargestValue) {
  write(pixel(16, kGrey, "", std::string("\x0c\x80", 2)));  // 3200: 200 of 12 bits
  const auto as_16 = read_camera_picture(file_);
  ASSERT_TRUE(as_16);
  EXPECT_EQ(as_16->largest, 3200u);
  EXPECT_EQ(as_16->grey.at(0, 0), 12);
  EXPECT_EQ(read_camera_picture(file_, used_bits_of(3200))->grey.at(0, 0), 200);
  EXPECT_EQ(read_camera_picture(file_, 10)->grey.at(0, 0), 255) << "beyond its bits";
  write(pixel(8, kGrey, "", "\x40"));
  EXPECT_EQ(read_camera_picture(file_, 12)->grey.at(0, 0), 64) << "of 8 bits";
  EXPECT_EQ(read_camera_picture(file_)->largest, 0u);
  for (const auto& [largest, bits] : {std::pair{0u, 16},
                                      {255u, 8},
                                      {256u, 10},
                                      {1023u, 10},
                                      {1024u, 12},
                                      {4095u, 12},
                                      {4096u, 16},
                                      {65520u, 16}})
    EXPECT_EQ(used_bits_of(largest), bits) << largest;
}

TEST_F(Png, LightFollowsTheProfileOfTheFileAndWithoutOneSrgb) {
  const auto level = [&](const std::string& extra) {
    write(pixel(8, kColour, extra, "\x40\x40\x40"));
    const auto grey = read_picture(file_)->at(0, 0);
    write(pixel(16, kColour, extra, "\x40\x40\x40\x40\x40\x40"));
    EXPECT_EQ(read_picture(file_)->at(0, 0), grey) << "of 16 bits";
    return int(grey & 255);
  };
  EXPECT_EQ(level(""), 64);
  EXPECT_EQ(level(gamma(45455)), 64);
  EXPECT_EQ(level(gamma(100000)), 137);  // by the curve of sRGB
  EXPECT_EQ(level(chunk("sRGB", "\1") + gamma(100000)), 64);
  EXPECT_EQ(level(icc_chunk(linear_profile("RGB "))), 137);
  EXPECT_EQ(level(icc_chunk(linear_profile("RGB ")) + gamma(45455)), 137) << "ICC comes first";
  EXPECT_EQ(level(icc_chunk("no profile")), 64);
  EXPECT_EQ(level(icc_chunk(linear_profile("CMYK"))), 64);
  EXPECT_EQ(level(icc_chunk(linear_profile("GRAY"))), 64) << "for a coloured picture";
  EXPECT_EQ(level(chunk("cICP", std::string("\1\x0d\0\1", 4)) + gamma(100000)), 64);
  write(pixel(8, kGrey, icc_chunk(linear_profile("GRAY")), "\x40"));
  EXPECT_EQ(read_picture(file_)->at(0, 0), 0xff898989u);
}

TEST_F(Png, AProfileThatCannotBeReadIsNamed) {
  testing::internal::CaptureStderr();
  write(pixel(8, kColour, icc_chunk(linear_profile("CMYK")), "\x40\x40\x40"));
  ASSERT_TRUE(read_picture(file_));
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              AllOf(HasSubstr("picture.png"), HasSubstr("profile 'A linear one'"),
                    HasSubstr("not for red, green and blue"), HasSubstr("to sRGB")));
}

TEST_F(Png, ColoursOfAWiderGamutAreThoseOfSrgb) {
  // Primaries of Adobe RGB (1998), adapted to D50.
  auto profile = linear_profile(
      "RGB ",
      {{{0.60974, 0.31111, 0.01947}, {0.20528, 0.62567, 0.06087}, {0.14919, 0.06322, 0.74457}}});
  write(pixel(8, kColour, icc_chunk(profile), std::string("\x40\x40\x40", 3)));
  EXPECT_EQ(read_picture(file_)->at(0, 0), 0xff898989u) << "white stays white";
  write(pixel(8, kColour, icc_chunk(profile), std::string("\x40\x20\x20", 3)));
  const auto red = read_picture(file_)->at(0, 0);
  EXPECT_GT(red & 255, 137u) << "it is redder than the red of sRGB";
}

TEST_F(Png, NoPaintIsNoLight) {
  const auto light = [&](const std::string& bytes) {
    write(bytes);
    const auto picture = read_picture(file_);
    return picture ? picture->at(0, 0) : 1u;
  };
  constexpr std::uint32_t kDark = 0xff000000, kHalf = 0xffbcbcbc, kWhite = 0xffffffff;
  const auto white_and = [](char alpha) { return std::string("\xff\xff\xff") + alpha; };
  EXPECT_EQ(light(pixel(8, kColourAlpha, "", white_and('\0'))), kDark);
  EXPECT_EQ(light(pixel(8, kColourAlpha, "", white_and('\x80'))), kHalf) << "half of the light";
  EXPECT_EQ(light(pixel(8, kColourAlpha, "", white_and('\xff'))), kWhite);
  EXPECT_EQ(light(pixel(8, kColourAlpha, gamma(100000), white_and('\x80'))), kHalf);
  EXPECT_EQ(light(pixel(8, kColourAlpha, gamma(100000), white_and('\0'))), kDark);
  EXPECT_EQ(light(pixel(8, kGreyAlpha, "", "\xff\x80")), kHalf);
  EXPECT_EQ(light(pixel(16, kGreyAlpha, "", "\xff\xff\x80\x80")), kHalf);
  EXPECT_EQ(light(pixel(16, kColourAlpha, "", std::string("\xff\xff\xff\xff\xff\xff\0\0", 8))),
            kDark);
  const auto palette = chunk("PLTE", "\xff\xff\xff\xff\xff\xff");
  const auto transparent = chunk("tRNS", std::string("\0\x80", 2));
  EXPECT_EQ(light(pixel(8, kPalette, palette + transparent, std::string(1, '\0'))), kDark);
  EXPECT_EQ(light(pixel(8, kPalette, palette + transparent, "\1")), kHalf);
  EXPECT_EQ(light(pixel(8, kGrey, chunk("tRNS", std::string("\0\xff", 2)), "\xff")), kDark);
  EXPECT_EQ(
      light(pixel(8, kColour, chunk("tRNS", std::string("\0\xff\0\xff\0\xff", 6)), "\xff\xff\xff")),
      kDark);
}

/// Five pixels in three rows: 0 to 4, turned so that the first row is to be seen where `corner` is.
TEST_F(Png, APictureIsTurnedAsAViewerTurnsIt) {
  struct Turn {
    int orientation;
    int width;
    std::array<int, 2> of_zero;  ///< column and row of a pixel 0
    int in_first_row;            ///< the value at the end of the first row
  };
  for (const auto& turn : {Turn{1, 5, {0, 0}, 4},
                           {2, 5, {4, 0}, 0},
                           {3, 5, {4, 2}, 0},
                           {4, 5, {0, 2}, 4},
                           {5, 3, {0, 0}, 0},
                           {6, 3, {2, 0}, 0},
                           {7, 3, {2, 4}, 4},
                           {8, 3, {0, 4}, 4}}) {
    for (const bool big : {false, true}) {
      write(picture(chunk("eXIf", exif(turn.orientation, big)), ""));
      const auto seen = read_picture(file_);
      const auto grey = read_camera_picture(file_);
      ASSERT_TRUE(seen && grey);
      ASSERT_EQ(seen->width(), turn.width) << turn.orientation;
      EXPECT_EQ(seen->at(turn.of_zero[0], turn.of_zero[1]), 0xff000000u) << turn.orientation;
      EXPECT_EQ(int(seen->at(turn.width - 1, 0) & 255), turn.in_first_row) << turn.orientation;
      EXPECT_EQ(int{grey->grey.at(turn.width - 1, 0)}, turn.in_first_row) << turn.orientation;
    }
  }
}

TEST_F(Png, AJpegIsTurnedAndFollowsItsProfileToo) {
  Texture picture(32, 16, 0xff404040);
  for (int y = 0; y < 16; ++y) std::fill_n(picture.row(y), 16, 0xff000000);  // its left half
  const auto encoded = jpeg_of(picture.view());
  const std::string jpeg(encoded.begin(), encoded.end());
  const auto with = [&](const std::string& segments) {
    write(jpeg.substr(0, 2) + segments + jpeg.substr(2));
  };
  const auto segment = [](char marker, const std::string& content) {
    return std::string("\xff") + marker +
           big_endian(static_cast<std::uint32_t>(content.size() + 2)).substr(2) + content;
  };
  with(segment('\xe1', std::string("Exif\0\0", 6) + exif(6, false)));
  const auto turned = read_picture(file_);
  ASSERT_TRUE(turned);
  ASSERT_EQ(turned->width(), 16);
  EXPECT_EQ(turned->at(8, 4), 0xff000000u) << "its left half is above";
  EXPECT_NEAR(turned->at(8, 28) & 255, 64, 2);
  EXPECT_NEAR(read_camera_picture(file_)->grey.at(8, 28), 64, 2);
  const auto profile = linear_profile("RGB ");
  const std::string name("ICC_PROFILE\0", 12);
  with(segment('\xe2', name + "\2\2" + profile.substr(100)) +
       segment('\xe2', name + "\1\2" + profile.substr(0, 100)));
  EXPECT_NEAR(read_picture(file_)->at(24, 8) & 255, 137, 2);
  EXPECT_NEAR(read_camera_picture(file_)->grey.at(24, 8), 64, 2) << "images of a camera are data";
}

/// The small inputs that once failed; empty if they are not here.
std::filesystem::path case_of(const std::string& name) {
  const char* data = std::getenv("HANDCAST_DATA");
  const auto file = std::filesystem::path(data ? data : "../shared/data") / "cases/pictures" / name;
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

TEST(PictureCases, GiveTheLightThatIsPainted) {
  if (case_of("reference8.png").empty()) GTEST_SKIP() << "HANDCAST_DATA has no folder 'cases'";
  EXPECT_EQ(read_picture(case_of("rgb16_no_gama.png"))->pixels(),
            read_picture(case_of("reference8.png"))->pixels());
  for (const auto* name : {"transparent_white.png", "palette_transparent.png"}) {
    const auto picture = read_picture(case_of(name));
    ASSERT_TRUE(picture) << name;
    EXPECT_EQ(picture->at(0, 0), 0xff000000u) << name;
    EXPECT_EQ(std::ranges::count(picture->pixels(), 0xffffffffu), 0) << name;
    EXPECT_GT(std::ranges::count(picture->pixels(), 0xff0000ffu), 1000) << name;
  }
  EXPECT_EQ(read_picture(case_of("half_transparent_white.png"))->at(0, 0), 0xffbcbcbcu);
}

TEST_F(Png, DamageIsLeftToTheDecoder) {
  const auto good = picture("", "");
  for (std::size_t size = 0; size + 16 < good.size(); ++size)
    EXPECT_FALSE(read(good.substr(0, size))) << size;
}

}  // namespace
}  // namespace handcast::renderer
