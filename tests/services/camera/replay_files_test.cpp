// SPDX-License-Identifier: Apache-2.0
// What the replay camera plays besides PNG images: recordings of `handcast record`, .npy arrays,
// films.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "renderer/media/film.hpp"
#include "services/camera/camera.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/scratch.hpp"
#include "tests/services/recording/recordings.hpp"

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class ReplayFiles : public testing::Test {
 protected:
  ReplayFiles() {
    set_size(recording::test::kWidth, recording::test::kHeight);
    rig_.camera.backend = "replay";
    rig_.camera.rate_hz = 200;
  }
  void set_size(int width, int height) {
    calibration_.camera.width_px = width;
    calibration_.camera.height_px = height;
  }
  Result<std::unique_ptr<Camera>> open(const std::filesystem::path& file) {
    rig_.camera.replay.directory = file;
    return open_camera(rig_, calibration_, epoch_ns_);
  }
  void expect_refused(const std::filesystem::path& file, const std::string& part) {
    const auto opened = open(file);
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().what, HasSubstr(part));
  }
  /// The next image; the test fails if there is none.
  msg::Owned<msg::CameraFrame> next(Camera& camera) const {
    msg::Owned<msg::CameraFrame> frame(
        msg::CameraFrame::bytes(static_cast<std::size_t>(calibration_.camera.width_px),
                                static_cast<std::size_t>(calibration_.camera.height_px)));
    const auto captured = camera.capture(*frame, frame.tail_bytes(), Deadline::in(10s));
    EXPECT_TRUE(captured) << captured.error().what;
    return frame;
  }
  /// An array of `count` images; each pixel of image i is i + 1.
  std::filesystem::path write_array(std::size_t count, const std::string& shape) const {
    const auto file = scratch_.path() / "images.npy";
    std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': " + shape + ", }";
    header.resize(117, ' ');
    std::ofstream out(file, std::ios::binary);
    out << "\x93NUMPY\x01" << '\0' << '\x76' << '\0' << header << '\n';
    for (std::size_t i = 0; i < count; ++i) out << std::string(35, static_cast<char>(i + 1));
    return file;
  }

  test::Scratch scratch_;
  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
  std::int64_t epoch_ns_ = now_ns() + to_ns(20ms);
};

TEST_F(ReplayFiles, ARecordingComesBackBitForBitAtItsTimes) {
  const auto folder = scratch_.path() / "recording";
  recording::test::write(folder, 20);
  const auto camera = open(folder);
  ASSERT_TRUE(camera) << camera.error().what;
  std::int64_t shift_ns = 0;
  for (int i = 0; i < 5; ++i) {
    const auto frame = next(**camera);
    const auto k = static_cast<std::uint32_t>(frame->header.frame_id - 100);
    if (k >= 20) break;  // the next lap, on a slow machine
    const auto expected = recording::test::frame(k);
    EXPECT_EQ(std::memcmp(frame->pixels(), expected->pixels(), 35), 0);
    EXPECT_EQ(frame->exposure_ns, expected->exposure_ns);
    const auto shift = frame->header.origin_ns - expected->header.origin_ns;
    if (i == 0) shift_ns = shift;
    EXPECT_EQ(shift, shift_ns);
    EXPECT_GE(now_ns() - frame->header.origin_ns, 300) << "its delay";
  }
}

TEST_F(ReplayFiles, ARecordingOfAnotherCameraIsRefused) {
  recording::test::write(scratch_.path() / "recording", 2);
  set_size(8, 5);
  expect_refused(scratch_.path() / "recording", "image 0 is 7 x 5 px");
}

TEST_F(ReplayFiles, ADamagedImageIsLeftOut) {
  const auto folder = scratch_.path() / "recording";
  recording::test::write(folder, 3);
  auto data = recording::test::contents(folder / "camera.frames.data");
  data[data.size() - 3] ^= 1;
  recording::test::replace(folder / "camera.frames.data", data);
  rig_.camera.replay.pace = config::Pace::fastest;
  const auto camera = open(folder);
  ASSERT_TRUE(camera);
  next(**camera), next(**camera);
  msg::Owned<msg::CameraFrame> frame(msg::CameraFrame::bytes(7, 5));
  const auto captured = (*camera)->capture(*frame, frame.tail_bytes(), Deadline::in(10s));
  ASSERT_FALSE(captured);
  EXPECT_EQ(captured.error().code, Errc::bad_data);
  EXPECT_EQ(next(**camera)->header.frame_id, 103u) << "the next lap";
}

TEST_F(ReplayFiles, AsFastAsTheyAreFetchedNoImageIsLeftOut) {
  const auto file = write_array(6, "(6, 5, 7)");
  rig_.camera.rate_hz = 1;
  rig_.camera.replay.pace = config::Pace::fastest;
  const auto camera = open(file);
  ASSERT_TRUE(camera) << camera.error().what;
  std::int64_t last_ns = 0;
  for (std::uint64_t i = 0; i < 15; ++i) {
    const auto frame = next(**camera);
    EXPECT_EQ(frame->header.frame_id, i);
    EXPECT_EQ(frame->pixels()[34], i % 6 + 1);
    EXPECT_GT(frame->header.origin_ns, last_ns);
    EXPECT_LE(frame->header.origin_ns, now_ns());
    last_ns = frame->header.origin_ns;
  }
}

TEST_F(ReplayFiles, AnArrayIsPlayedAtTheRateOfTheSettingsOrAtItsTimes) {
  const auto file = write_array(4, "(4, 5, 7)");
  for (const bool has_times : {false, true}) {
    if (has_times) {
      ASSERT_TRUE(recording::write_npy_i64(scratch_.path() / "camera_timestamps.npy",
                                           {0, 7'000, 17'000, 27'000}));
    }
    const auto camera = open(file);
    ASSERT_TRUE(camera) << camera.error().what;
    const auto frame = next(**camera);
    const auto k = static_cast<std::int64_t>(frame->header.frame_id);
    const std::array<std::int64_t, 4> at_ms{0, 7, 17, 27};
    EXPECT_EQ(frame->header.origin_ns - epoch_ns_,
              has_times ? k / 4 * 36'000'000 + at_ms[k % 4] * 1'000'000 : k * 5'000'000)
        << k;
  }
}

TEST_F(ReplayFiles, AnArrayOfAnotherShapeOrSizeIsRefused) {
  expect_refused(write_array(4, "(4, 7, 5)"), "for images of (n, 5, 7)");
  expect_refused(write_array(4, "(4, 35)"), "has the shape (4, 35)");
  expect_refused(write_array(3, "(4, 5, 7)"), "not what its shape requires");
  expect_refused(write_array(0, "(4294967295, 4294967295, 4294967295)"), "bytes of data");
  expect_refused(write_array(0, "(0, 5, 7)"), "empty");
}

TEST_F(ReplayFiles, AFilmIsPlayedAtItsRate) {
  set_size(64, 48);
  const auto file = scratch_.path() / "film.avi";
  {
    cv::VideoWriter film(file.string(), cv::CAP_OPENCV_MJPEG,
                         cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 50, {64, 48}, true);
    for (int i = 0; i < 5; ++i) film.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(40 + 40 * i)));
  }
  const auto camera = open(file);
  ASSERT_TRUE(camera) << camera.error().what;
  for (int i = 0; i < 7; ++i) {
    const auto frame = next(**camera);
    const auto k = static_cast<std::int64_t>(frame->header.frame_id);
    EXPECT_NEAR(frame->pixels()[1000], 40 + 40 * (k % 5), 3) << k;
    EXPECT_EQ(frame->header.origin_ns, epoch_ns_ + k * 20'000'000);
  }
  set_size(64, 50);
  expect_refused(file, "is 64 x 48 px");
  std::ofstream(scratch_.path() / "text.avi") << "no film";
  expect_refused(scratch_.path() / "text.avi", "no film that FFmpeg can read");
}

/// The small inputs that once failed; empty if they are not here.
std::filesystem::path case_of(const std::string& name) {
  const char* data = std::getenv("HANDCAST_DATA");
  const auto file = std::filesystem::path(data ? data : "../shared/data") / "cases" / name;
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

/// Frames 33 ms apart, a pause of 3 s, then 17 ms.
TEST_F(ReplayFiles, AFilmIsPlayedAtItsOwnTimes) {
  const auto file = case_of("films/variable.mov");
  if (file.empty()) GTEST_SKIP() << "HANDCAST_DATA has no folder 'cases'";
  set_size(720, 540);
  std::vector<double> at_ms;
  for (int i = 0; i < 24; ++i)
    at_ms.push_back(i < 8    ? i * 100 / 3.0
                    : i < 16 ? 3000 + (i - 1) * 100 / 3.0
                             : 3500 + (i - 16) * 50 / 3.0);
  const double lap_ms = at_ms.back() * 24 / 23;
  for (const std::size_t begin : {0, 6, 20}) {  // also a rig that starts again in the middle
    epoch_ns_ = now_ns() + to_ns(50ms) - static_cast<std::int64_t>(at_ms[begin] * 1e6);
    const auto camera = open(file);
    ASSERT_TRUE(camera) << camera.error().what;
    for (int i = 0; i < 3; ++i) {
      const auto frame = next(**camera);
      const auto k = frame->header.frame_id;
      EXPECT_NEAR(ns_to_ms(frame->header.origin_ns - epoch_ns_),
                  at_ms[k % 24] + lap_ms * static_cast<double>(k / 24), 1)
          << k;
    }
  }
}

/// The film with the matrix of its track: what a telephone writes that was held upright.
TEST_F(ReplayFiles, AFilmIsTurnedAsItAsksFor) {
  const auto film = case_of("films/variable.mov");
  if (film.empty()) GTEST_SKIP() << "HANDCAST_DATA has no folder 'cases'";
  set_size(720, 540);
  rig_.camera.replay.pace = config::Pace::fastest;
  const auto upright = next(**open(film));
  auto bytes = recording::test::contents(film);
  const auto matrix = bytes.find("tkhd") + 4 + 40;
  const auto put = [&](std::size_t k, std::int32_t value) {
    for (int i = 0; i < 4; ++i)
      bytes[matrix + 4 * k + static_cast<std::size_t>(i)] =
          static_cast<char>(value >> (24 - 8 * i));
  };
  put(0, 0), put(1, 1 << 16), put(3, -(1 << 16)), put(4, 0);
  const auto file = scratch_.path() / "turned.mov";
  recording::test::replace(file, bytes);
  set_size(540, 720);
  const auto camera = open(file);
  ASSERT_TRUE(camera) << camera.error().what;
  const auto turned = next(**camera);
  for (int y = 0; y < 540; y += 7)
    for (int x = 0; x < 720; x += 7)
      ASSERT_EQ(turned->pixels()[x * 540 + 539 - y], upright->pixels()[y * 720 + x])
          << x << ' ' << y;
}

TEST_F(ReplayFiles, TransparentPartsOfAFilmAreDark) {
  cv::Mat picture(6, 8, CV_8UC4, cv::Scalar(255, 255, 255, 0));
  picture.colRange(4, 8).setTo(cv::Scalar(200, 200, 200, 128));
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png);
  const auto file = scratch_.path() / "transparent.avi";
  {
    auto film = renderer::Film::create(file, 8, 6);
    ASSERT_TRUE(film);
    for (const std::int64_t time_ns : {0, 40'000'000}) ASSERT_TRUE(film->add(png, time_ns));
  }
  auto bytes = recording::test::contents(file);
  for (auto at = bytes.find("MJPG"); at != std::string::npos; at = bytes.find("MJPG"))
    bytes.replace(at, 4, "MPNG");
  recording::test::replace(file, bytes);
  set_size(8, 6);
  rig_.camera.replay.pace = config::Pace::fastest;
  const auto camera = open(file);
  ASSERT_TRUE(camera) << camera.error().what;
  const auto frame = next(**camera);
  EXPECT_EQ(frame->pixels()[2], 0);
  EXPECT_NEAR(frame->pixels()[6], 100, 1);
}

}  // namespace
}  // namespace handcast::camera
