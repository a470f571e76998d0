// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "services/camera/camera.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/scratch.hpp"
#include "tests/services/camera/pictures.hpp"

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class ReplayCamera : public testing::Test {
 protected:
  ReplayCamera() {
    calibration_.camera.width_px = kWidth;
    calibration_.camera.height_px = kHeight;
    rig_.camera.backend = "replay";
    rig_.camera.rate_hz = 200;
    rig_.camera.replay.directory = scratch_.path();
  }
  Result<std::unique_ptr<Camera>> open() { return open_camera(rig_, calibration_, now_ns()); }
  void expect_refused(const std::string& part) {
    const auto opened = open();
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, Errc::bad_config);
    EXPECT_THAT(opened.error().what, HasSubstr(part));
  }

  static constexpr int kWidth = 8, kHeight = 6;
  test::Scratch scratch_;
  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
};

struct SmallFrame {
  msg::CameraFrame frame;
  std::array<std::uint8_t, 48> pixels{};
};

TEST_F(ReplayCamera, PlaysThePicturesInTheirOrderOverAndOver) {
  test::write_pictures(scratch_.path() / "camera", 3, kWidth, kHeight);
  const auto camera = open();
  ASSERT_TRUE(camera) << camera.error().what;
  for (int i = 0; i < 9; ++i) {
    SmallFrame shot;
    ASSERT_TRUE((*camera)->capture(shot.frame, shot.pixels.size(), Deadline::in(5s)));
    EXPECT_THAT(shot.pixels, testing::Each(10 + shot.frame.header.frame_id % 3));
  }
}

TEST_F(ReplayCamera, NumbersInNamesAreNumbers) {
  test::write_pictures(scratch_.path() / "source", 12, kWidth, kHeight);
  std::filesystem::create_directory(scratch_.path() / "camera");
  for (int i = 0; i < 12; ++i)
    std::filesystem::copy(
        scratch_.path() / fmt::format("source/{:04}.png", i),
        scratch_.path() / fmt::format("camera/cam2_{}.{}", 3 * i + 5, i % 2 == 0 ? "png" : "PNG"));
  std::ofstream(scratch_.path() / "camera/._cam2_5.png") << "what macOS adds to a file";
  const auto camera = open();
  ASSERT_TRUE(camera) << camera.error().what;
  for (int i = 0; i < 14; ++i) {
    SmallFrame shot;
    ASSERT_TRUE((*camera)->capture(shot.frame, shot.pixels.size(), Deadline::in(5s)));
    EXPECT_THAT(shot.pixels, testing::Each(10 + shot.frame.header.frame_id % 12));
  }
}

TEST_F(ReplayCamera, ImagesThatUseTwelveOfSixteenBitsAreNotDark) {
  for (const int factor : {1, 16}) {  // in the lower or the upper 12 bits
    for (int i = 0; i < 3; ++i)
      cv::imwrite((scratch_.path() / fmt::format("{}.png", i)).string(),
                  cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(factor * (160 + 1600 * i))));
    const auto camera = open();
    ASSERT_TRUE(camera) << camera.error().what;
    for (int i = 0; i < 4; ++i) {
      SmallFrame shot;
      ASSERT_TRUE((*camera)->capture(shot.frame, shot.pixels.size(), Deadline::in(5s)));
      EXPECT_THAT(shot.pixels, testing::Each(10 + 100 * (shot.frame.header.frame_id % 3)));
    }
  }
}

TEST_F(ReplayCamera, OriginsFollowTheTimeStamps) {
  test::write_pictures(scratch_.path(), 3, kWidth, kHeight);
  ASSERT_TRUE(recording::write_npy_i64(scratch_.path() / "camera_timestamps.npy",
                                       {5'000'000, 5'010'000, 5'040'000}));
  const std::int64_t epoch_ns = now_ns() + to_ns(50ms);
  const auto camera = open_camera(rig_, calibration_, epoch_ns);
  ASSERT_TRUE(camera) << camera.error().what;
  const std::array<std::int64_t, 3> since_epoch_ns{0, to_ns(10ms), to_ns(40ms)};
  for (int i = 0; i < 3; ++i) {
    SmallFrame shot;
    ASSERT_TRUE((*camera)->capture(shot.frame, shot.pixels.size(), Deadline::in(5s)));
    const auto id = shot.frame.header.frame_id;
    EXPECT_EQ(shot.frame.header.origin_ns,
              epoch_ns + static_cast<std::int64_t>(id / 3) * to_ns(60ms) + since_epoch_ns[id % 3]);
  }
}

TEST_F(ReplayCamera, IsATimeoutAtItsEndWhereItIsNotToRepeat) {
  test::write_pictures(scratch_.path(), 1, kWidth, kHeight);
  rig_.camera.replay.loop = false;
  const auto camera = open_camera(rig_, calibration_, now_ns() - to_ns(1s));
  ASSERT_TRUE(camera);
  SmallFrame shot;
  const auto captured = (*camera)->capture(shot.frame, shot.pixels.size(), Deadline::in(1ms));
  ASSERT_FALSE(captured);
  EXPECT_EQ(captured.error().code, Errc::timeout);
  EXPECT_THAT(captured.error().what, HasSubstr("over"));
}

TEST_F(ReplayCamera, SaysWhenNoFolderIsNamed) {
  rig_.camera.replay.directory.clear();
  expect_refused("set replay.directory");
}

TEST_F(ReplayCamera, SaysWhenTheFolderIsMissing) {
  rig_.camera.replay.directory = scratch_.path() / "nowhere";
  expect_refused("nowhere' is not a folder");
}

TEST_F(ReplayCamera, SaysWhenTheFolderHoldsNoPicture) { expect_refused("no PNG image"); }

TEST_F(ReplayCamera, SaysWhichPictureHasAnotherSize) {
  test::write_pictures(scratch_.path(), 1, kWidth + 1, kHeight);
  expect_refused("0000.png' is 9 x 6 px");
}

TEST_F(ReplayCamera, SaysWhichFileIsNoPicture) {
  std::ofstream(scratch_.path() / "0001.png") << "not a picture";
  expect_refused("0001.png' is not a PNG or JPEG picture");
}

TEST_F(ReplayCamera, SaysWhenTimesAndPicturesDoNotPair) {
  test::write_pictures(scratch_.path(), 2, kWidth, kHeight);
  ASSERT_TRUE(
      recording::write_npy_i64(scratch_.path() / "camera_timestamps.npy", {0, 10'000, 20'000}));
  expect_refused("3 times for 2 images");
}

}  // namespace
}  // namespace handcast::camera
