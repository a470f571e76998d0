// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
// needs cstdio
#include <jpeglib.h>

#include "renderer/content/textures.hpp"
#include "renderer/media/picture.hpp"

namespace handcast::renderer {
namespace {

using ::testing::HasSubstr;

/// Two square sheets 100 mm wide, the back in chart 1 (left half of the texture) and the palm in
/// chart 2.
HandMesh two_sheets() {
  HandMesh hand;
  for (const int side : {0, 1}) {
    const auto first = static_cast<std::uint16_t>(hand.positions.size());
    for (const auto& [x, z] :
         {std::pair{-0.05f, -0.05f}, {0.05f, -0.05f}, {0.05f, 0.05f}, {-0.05f, 0.05f}}) {
      hand.positions.emplace_back(x, 0, z);
      hand.normals.emplace_back(0, side == 0 ? 1 : -1, 0);
      hand.uv.emplace_back(0.25f + 0.5f * side + 2 * (side == 0 ? x : -x), 0.5f + 4 * z);
      hand.joints.push_back({0, 0, 0, 0});
      hand.weights.push_back({1, 0, 0, 0});
      hand.chart.push_back(static_cast<std::uint8_t>(side + 1));
    }
    hand.triangles.push_back(
        {first, static_cast<std::uint16_t>(first + 1), static_cast<std::uint16_t>(first + 2)});
    hand.triangles.push_back(
        {first, static_cast<std::uint16_t>(first + 2), static_cast<std::uint16_t>(first + 3)});
  }
  hand.rest.fill(glm::mat4(1));
  return hand;
}

/// A file in the temporary folder, which the destructor removes.
class TemporaryFile {
 public:
  TemporaryFile(const char* name, std::string_view bytes)
      : path_(std::filesystem::temp_directory_path() / name) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(Content, EveryBuiltinPaintsTheWholeLayout) {
  const HandMesh hand = two_sheets();
  for (const char* name : {"atlas", "checker", "skeleton", "white"}) {
    const auto texture = load_content(std::string("builtin:") + name, hand);
    ASSERT_TRUE(texture) << texture.error().what;
    EXPECT_EQ(texture->width(), 1024);
    EXPECT_EQ(texture->height(), 640);
    for (const std::uint32_t texel : texture->pixels()) ASSERT_EQ(texel >> 24, 255u);
  }
}

TEST(Content, ColoursGoOnPastTheChartsOutline) {
  const auto texture = load_content("builtin:checker", two_sheets());
  ASSERT_TRUE(texture);
  constexpr int kRight = static_cast<int>(0.35 * 1024) - 1;  // last column of chart 1
  for (int away = 4; away <= 20; ++away)
    EXPECT_EQ(texture->at(kRight + away, 320), texture->at(kRight + 4, 320)) << away;
  EXPECT_NE(texture->at(kRight + 4, 320), texture->at(512, 20))
      << "the padding has the colour of the background";
}

TEST(Content, BackAndPalmOfTheAtlasDiffer) {
  const auto texture = load_content("builtin:atlas", two_sheets());
  ASSERT_TRUE(texture);
  EXPECT_NE(texture->at(256 + 20, 300), texture->at(768 - 20, 300));
}

TEST(Content, AnUnknownBuiltinIsNamedTogetherWithTheKnownOnes) {
  const auto texture = load_content("builtin:stripes", two_sheets());
  ASSERT_FALSE(texture);
  EXPECT_EQ(texture.error().code, Errc::bad_config);
  EXPECT_THAT(texture.error().what, HasSubstr("stripes"));
  EXPECT_THAT(texture.error().what, HasSubstr("atlas"));
}

TEST(Content, AMissingFileAndAFileThatIsNoPictureAreToldApart) {
  const auto missing = load_content("/nowhere/picture.png", two_sheets());
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::bad_config);
  EXPECT_THAT(missing.error().what,
              HasSubstr("/nowhere/picture.png: cannot be read: No such file"));
  const TemporaryFile text("handcast_content_test.png", "this is not a picture");
  const auto wrong = load_content(text.path(), two_sheets());
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Errc::bad_config);
  EXPECT_THAT(wrong.error().what, HasSubstr("not a PNG or JPEG"));
}

TEST(Content, AMissingGreyPngIsNotReportedAsADamagedOne) {
  const auto missing = read_camera_picture("/nowhere/picture.png");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::bad_config);
  EXPECT_THAT(missing.error().what,
              HasSubstr("/nowhere/picture.png: cannot be read: No such file"));
}

TEST(Content, APictureIsReadWithRedInTheLowestByteAndTheTopRowFirst) {
  using namespace std::string_view_literals;
  // A PNG of 2 x 2 px: red, green / blue, white.
  const TemporaryFile picture(
      "handcast_content_test.png",
      "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x02\x00\x00\x00"
      "\x02\x08\x02\x00\x00"
      "\x00\xfd\xd4\x9a\x73\x00\x00\x00\x12\x49\x44\x41\x54\x78\xda\x63\xf8\xcf\xc0\xc0\x00\xc2\x0c"
      "\xff\x81\x00\x00\x1f"
      "\xee\x05\xfb\xf1\xab\xba\x77\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82"sv);
  const auto texture = load_content(picture.path(), two_sheets());
  ASSERT_TRUE(texture) << texture.error().what;
  EXPECT_EQ(texture->at(0, 0), 0xff0000ffu);
  EXPECT_EQ(texture->at(1, 0), 0xff00ff00u);
  EXPECT_EQ(texture->at(0, 1), 0xffff0000u);
  EXPECT_EQ(texture->at(1, 1), 0xffffffffu);
}

TEST(Content, WhatIsWrittenIsReadBackAndBrokenFilesAreNotPictures) {
  Texture picture(3, 2);
  for (int i = 0; i < 6; ++i)
    picture.pixels()[static_cast<std::size_t>(i)] =
        0xff000000u | static_cast<std::uint32_t>(i * 0x0a0b0c);
  const TemporaryFile file("handcast_content_test.png", "");
  ASSERT_TRUE(write_png(file.path(), picture.view()));
  const auto back = read_picture(file.path());
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->pixels(), picture.pixels());

  const TemporaryFile cut("handcast_content_cut.png", "\x89PNG\r\n\x1a\n and no more");
  EXPECT_EQ(read_picture(cut.path()).error().code, Errc::bad_config);
  const TemporaryFile jpeg("handcast_content_cut.jpg", "\xff\xd8\xff\xe0 and no more");
  EXPECT_EQ(read_picture(jpeg.path()).error().code, Errc::bad_config);
  EXPECT_FALSE(write_png("/nowhere/picture.png", picture.view()));
}

TEST(Picture, AFullDeviceIsASentenceAndTheDeviceStays) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const auto written = write_png("/dev/full", Texture(4, 4, 0xffffffffu).view());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::unavailable);
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

/// Each coefficient of each of three components in a scan of its own, after the mean: 190 scans.
std::vector<jpeg_scan_info> one_scan_per_coefficient() {
  std::vector<jpeg_scan_info> scans{{3, {0, 1, 2}, 0, 0, 0, 0}};
  for (int component = 0; component < 3; ++component)
    for (int k = 1; k < 64; ++k) scans.push_back({1, {component}, k, k, 0, 0});
  return scans;
}

/// A JPEG file with a square of noise. With `scans` it is progressive.
std::string jpeg_of(J_COLOR_SPACE colours, int components,
                    const std::vector<jpeg_scan_info>& scans = {}) {
  constexpr int kSide = 64;
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = jpeg.image_height = kSide;
  jpeg.input_components = components;
  jpeg.in_color_space = colours;
  jpeg_set_defaults(&jpeg);
  if (!scans.empty()) {
    jpeg.scan_info = scans.data();
    jpeg.num_scans = static_cast<int>(scans.size());
  }
  jpeg_start_compress(&jpeg, TRUE);
  std::mt19937 random(1);
  std::vector<JSAMPLE> row(static_cast<std::size_t>(kSide) * components);
  while (jpeg.next_scanline < kSide) {
    for (JSAMPLE& sample : row) sample = static_cast<JSAMPLE>(random());
    JSAMPLE* line = row.data();
    jpeg_write_scanlines(&jpeg, &line, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::string file(reinterpret_cast<const char*>(bytes), size);
  jpeg_destroy_compress(&jpeg);
  std::free(bytes);
  return file;
}

TEST(Content, AProgressiveJpegIsReadAndOneOfHundredsOfScansIsRefused) {
  auto scans = one_scan_per_coefficient();
  const TemporaryFile bomb("handcast_content_scans.jpg", jpeg_of(JCS_RGB, 3, scans));
  const auto refused = read_picture(bomb.path());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("has more than 100 scans"));
  scans.resize(64);
  const TemporaryFile good("handcast_content_scans.jpg", jpeg_of(JCS_RGB, 3, scans));
  EXPECT_TRUE(read_picture(good.path()));
}

TEST(Content, AJpegThatEndsTooEarlyIsRefused) {
  const std::string whole = jpeg_of(JCS_RGB, 3);
  const TemporaryFile file("handcast_content_whole.jpg", whole);
  ASSERT_TRUE(read_picture(file.path()));
  for (const std::size_t size : {whole.size() / 2, whole.size() - 20}) {
    const TemporaryFile cut("handcast_content_cut.jpg", std::string_view(whole).substr(0, size));
    const auto picture = read_picture(cut.path());
    ASSERT_FALSE(picture) << size;
    EXPECT_EQ(picture.error().code, Errc::bad_config);
    EXPECT_THAT(picture.error().what, HasSubstr("handcast_content_cut.jpg' is truncated"));
  }
}

TEST(Content, AJpegForPrintersIsRefusedByItsColours) {
  const TemporaryFile grey("handcast_content_grey.jpg", jpeg_of(JCS_GRAYSCALE, 1));
  EXPECT_TRUE(read_picture(grey.path()));
  const TemporaryFile print("handcast_content_print.jpg", jpeg_of(JCS_CMYK, 4));
  const auto picture = read_picture(print.path());
  ASSERT_FALSE(picture);
  EXPECT_THAT(picture.error().what, HasSubstr("CMYK"));
}

TEST(Content, APictureThatIsStretchedIsSaidWithBothSizes) {
  EXPECT_EQ(note_on_proportions("good.png", Texture(1920, 1200)), "");
  EXPECT_EQ(note_on_proportions("good.png", Texture(1023, 640)), "");
  EXPECT_THAT(note_on_proportions("square.png", Texture(1000, 1000)),
              AllOf(HasSubstr("'square.png' has 1000 x 1000 px, its template 1024 x 640"),
                    HasSubstr("to 160 % of its width")));
  EXPECT_THAT(note_on_proportions("wide.png", Texture(3200, 1000)),
              HasSubstr("to 200 % of its height"));
}

}  // namespace
}  // namespace handcast::renderer
