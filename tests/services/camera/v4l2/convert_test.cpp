// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/convert.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

namespace handcast::camera::v4l2 {
namespace {

using config::WebcamFormat;
using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

Result<Bytes> grey_of(const Layout& layout, const Bytes& bytes) {
  Bytes grey(static_cast<std::size_t>(layout.width_px) * layout.height_px, 7);
  if (auto converted = to_grey(layout, bytes, grey); !converted)
    return tl::make_unexpected(converted.error());
  return grey;
}

TEST(ToGrey, GreyIsCopiedWithoutThePadding) {
  EXPECT_THAT(*grey_of({WebcamFormat::grey, 3, 2, 5}, {1, 2, 3, 90, 91, 4, 5, 255}),
              ElementsAre(1, 2, 3, 4, 5, 255));
}

TEST(ToGrey, Y16GivesTheHighByteOfEachLittleEndianWord) {
  EXPECT_THAT(*grey_of({WebcamFormat::y16, 3, 2, 8}, {0xff, 0x00, 0x00, 0x01, 0x34, 0x12, 90, 91,
                                                      0xff, 0xff, 0x00, 0x80, 0xff, 0x7f}),
              ElementsAre(0, 1, 0x12, 0xff, 0x80, 0x7f));
}

TEST(ToGrey, Y10GivesTheEightHighestOfTenBitsWhateverIsAboveThem) {
  EXPECT_THAT(*grey_of({WebcamFormat::y10, 3, 2, 6},
                       {0xff, 0x03, 0x03, 0x00, 0x04, 0x00, 0x00, 0x02, 0xfc, 0xfd, 0x00, 0xfc}),
              ElementsAre(255, 0, 1, 128, 127, 0));
}

TEST(ToGrey, YuyvGivesTheLumaAlsoOfAnOddWidth) {
  EXPECT_THAT(
      *grey_of({WebcamFormat::yuyv, 3, 2, 8}, {1, 90, 2, 91, 3, 92, 93, 94, 4, 90, 5, 91, 255, 92}),
      ElementsAre(1, 2, 3, 4, 5, 255));
}

TEST(ToGrey, Nv12GivesItsFirstPlane) {
  EXPECT_THAT(*grey_of({WebcamFormat::nv12, 3, 3, 4},
                       {1, 2, 3, 90, 4, 5, 6, 90, 7, 8, 9, 90, 128, 128, 128, 128, 128, 128, 128}),
              ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
}

TEST(ToGrey, WideRowsAreConvertedLikeNarrowOnes) {
  for (const int width : {31, 32, 33, 67, 720}) {
    Bytes words, expected16, expected10;
    for (int i = 0; i < 2 * width; ++i) {
      const int word = i * 977 % 65536;
      words.push_back(static_cast<std::uint8_t>(word));
      words.push_back(static_cast<std::uint8_t>(word >> 8));
      expected16.push_back(static_cast<std::uint8_t>(word >> 8));
      expected10.push_back(static_cast<std::uint8_t>((word & 1023) >> 2));
    }
    Bytes low;
    for (std::size_t i = 0; i < words.size(); i += 2) low.push_back(words[i]);
    const auto row = static_cast<std::size_t>(2 * width);
    EXPECT_EQ(*grey_of({WebcamFormat::y16, width, 2, row}, words), expected16) << width;
    EXPECT_EQ(*grey_of({WebcamFormat::y10, width, 2, row}, words), expected10) << width;
    EXPECT_EQ(*grey_of({WebcamFormat::yuyv, width, 2, row}, words), low) << width;
  }
}

TEST(ToGrey, AnImageThatEndsTooEarlyIsBadData) {
  for (const auto format : {WebcamFormat::grey, WebcamFormat::y16, WebcamFormat::y10,
                            WebcamFormat::yuyv, WebcamFormat::nv12}) {
    const Layout layout{format, 4, 3, 12};
    const auto needed = least_bytes(layout);
    EXPECT_EQ(needed, 24 + 4 * bytes_per_pixel(format));
    EXPECT_TRUE(grey_of(layout, Bytes(needed)));
    const auto refused = grey_of(layout, Bytes(needed - 1));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::bad_data);
    EXPECT_THAT(refused.error().what, HasSubstr("instead of"));
  }
}

class MotionJpeg : public testing::Test {
 protected:
  static constexpr int kWidth = 97, kHeight = 61;
  static constexpr Layout kLayout{WebcamFormat::mjpeg, kWidth, kHeight, 0};

  static std::uint8_t slope(int x, int y) { return static_cast<std::uint8_t>(30 + x + 2 * y); }

  /// A slope of grey in colour, as a webcam sends it.
  static Bytes encode(int width = kWidth, int height = kHeight, std::vector<int> options = {}) {
    cv::Mat picture(height, width, CV_8UC3);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        picture.at<cv::Vec3b>(y, x) = {slope(x, y), slope(x, y), slope(x, y)};
    Bytes bytes;
    cv::imencode(".jpg", picture, bytes, options);
    return bytes;
  }
  static Bytes without_tables(const Bytes& jpeg) {
    Bytes shorter(jpeg.begin(), jpeg.begin() + 2);
    for (std::size_t at = 2; at + 4 <= jpeg.size();) {
      const std::size_t length = 2 + (jpeg[at + 2] << 8 | jpeg[at + 3]);
      const bool is_scan = jpeg[at + 1] == 0xda;
      const auto end = is_scan ? jpeg.end() : jpeg.begin() + static_cast<long>(at + length);
      if (jpeg[at + 1] != 0xc4)
        shorter.insert(shorter.end(), jpeg.begin() + static_cast<long>(at), end);
      if (is_scan) break;
      at += length;
    }
    return shorter;
  }
  static void expect_slope(const Result<Bytes>& grey) {
    ASSERT_TRUE(grey) << grey.error().what;
    int worst = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        worst = std::max(worst, std::abs((*grey)[y * kWidth + x] - slope(x, y)));
    EXPECT_LE(worst, 3) << "what JPEG loses";
  }
  static void expect_refused(const Bytes& bytes, const std::string& part) {
    const auto refused = grey_of(kLayout, bytes);
    ASSERT_FALSE(refused) << part;
    EXPECT_EQ(refused.error().code, Errc::bad_data);
    EXPECT_THAT(refused.error().what, HasSubstr(part));
  }
};

TEST_F(MotionJpeg, GivesTheLuma) { expect_slope(grey_of(kLayout, encode())); }

TEST_F(MotionJpeg, NeedsNoHuffmanTables) {
  const auto jpeg = encode();
  const auto shorter = without_tables(jpeg);
  ASSERT_LT(shorter.size(), jpeg.size() - 300);
  expect_slope(grey_of(kLayout, shorter));
}

TEST_F(MotionJpeg, ToleratesPaddingAndAMissingMarkerAtItsEnd) {
  auto jpeg = encode();
  jpeg.resize(jpeg.size() + 100);
  expect_slope(grey_of(kLayout, jpeg));
  jpeg.resize(jpeg.size() - 102);
  expect_slope(grey_of(kLayout, jpeg));
}

TEST_F(MotionJpeg, IsBadDataAtWhateverByteItIsCut) {
  const auto jpeg = encode();
  // The last bytes hold the marker of the end, and bits that only pad.
  for (std::size_t size = 0; size + 10 < jpeg.size(); size += 7)
    EXPECT_FALSE(grey_of(kLayout, Bytes(jpeg.begin(), jpeg.begin() + static_cast<long>(size))))
        << size << " of " << jpeg.size();
  expect_refused(Bytes(jpeg.begin(), jpeg.begin() + static_cast<long>(jpeg.size() / 2 + 100)),
                 "is truncated");
}

TEST_F(MotionJpeg, IsBadDataIfItIsDamaged) {
  auto jpeg = encode();
  std::fill(jpeg.end() - 300, jpeg.end() - 250, std::uint8_t{0xfe});
  EXPECT_FALSE(grey_of(kLayout, jpeg));
}

TEST_F(MotionJpeg, IsBadDataIfItIsSomethingElse) {
  expect_refused({}, "is not a JPEG image");
  expect_refused(Bytes(5000, 0), "is not a JPEG image");
  expect_refused(encode(kWidth + 1), "has another size");
  expect_refused(encode(kWidth, kHeight, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}), "is progressive");
}

}  // namespace
}  // namespace handcast::camera::v4l2
