// SPDX-License-Identifier: Apache-2.0
// The replay back ends of the sensors, playing one folder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/camera/camera.hpp"
#include "services/landmarks/detector.hpp"
#include "services/pose/pose_source.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/scratch.hpp"
#include "tests/services/camera/pictures.hpp"

namespace handcast {
namespace {

using namespace std::chrono_literals;
using Stamps = std::vector<std::int64_t>;

constexpr int kWidth = 8, kHeight = 6;
constexpr std::int64_t kFirst_us = 5'000'000;  ///< by the recording's clock

/// Files that begin and end at different times: the poses first, the pictures last. A lap takes 100
/// ms.
const Stamps kPoses_us{kFirst_us, kFirst_us + 9'000, kFirst_us + 21'000, kFirst_us + 30'000};
const Stamps kLandmarks_us{kFirst_us + 3'000, kFirst_us + 23'000, kFirst_us + 43'000};
const Stamps kPictures_us{kFirst_us + 7'000, kFirst_us + 38'000, kFirst_us + 69'000};
constexpr std::int64_t kLap_ns = 100'000'000;

struct SmallFrame {
  msg::CameraFrame frame;
  std::array<std::uint8_t, kWidth * kHeight> pixels{};
};

class Replay : public testing::Test {
 protected:
  Replay() {
    calibration_.camera.width_px = kWidth;
    calibration_.camera.height_px = kHeight;
    rig_.camera.backend = rig_.pose.backend = rig_.landmarks.backend = "replay";
    rig_.camera.replay.directory = rig_.pose.replay.directory = rig_.landmarks.replay.directory =
        scratch_.path();

    recording::RecordedHands recording;
    recording.first_ns = kPoses_us.front() * 1000;
    for (const auto time_us : kPoses_us) {
      recording.time_ns.push_back(time_us * 1000 - recording.first_ns);
      recording.hands[0].emplace_back();
    }
    EXPECT_TRUE(recording::write_recording(scratch_.path(), recording));
    test::write_pictures(scratch_.path() / "camera", 3, kWidth, kHeight);
    EXPECT_TRUE(recording::write_npy_i64(scratch_.path() / "camera_timestamps.npy", kPictures_us));
    std::vector<float> points;
    for (const float x : {100, 101, 102}) points.insert(points.end(), 42, x);
    EXPECT_TRUE(
        recording::write_npy_f32(scratch_.path() / "landmarks_left.npy", {3, 21, 2}, points));
    EXPECT_TRUE(
        recording::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", kLandmarks_us));
  }

  /// When an item was taken, played in the lap that its number says.
  std::int64_t due_ns(const Stamps& stamps_us, std::uint64_t number) const {
    const auto lap = static_cast<std::int64_t>(number / stamps_us.size());
    return epoch_ns_ + lap * kLap_ns + (stamps_us[number % stamps_us.size()] - kFirst_us) * 1000;
  }

  test::Scratch scratch_;
  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
  std::int64_t epoch_ns_ = now_ns() - 1000 * kLap_ns;
};

TEST_F(Replay, TheSensorsOfAFolderStayTogetherOverManyLaps) {
  const auto camera = camera::open_camera(rig_, calibration_, epoch_ns_);
  const auto pose = pose::open_pose_source(rig_, calibration_, epoch_ns_);
  const auto detector = landmarks::open_detector(rig_, calibration_, epoch_ns_);
  ASSERT_TRUE(camera) << camera.error().what;
  ASSERT_TRUE(pose) << pose.error().what;
  ASSERT_TRUE(detector) << detector.error().what;
  for (int i = 0; i < 4; ++i) {
    SmallFrame shot;
    ASSERT_TRUE((*camera)->capture(shot.frame, shot.pixels.size(), Deadline::in(5s)));
    EXPECT_EQ(shot.frame.header.origin_ns, due_ns(kPictures_us, shot.frame.header.frame_id));
    msg::HandPoses poses;
    ASSERT_TRUE((*pose)->sample(poses, Deadline::in(5s)));
    EXPECT_EQ(poses.header.origin_ns, due_ns(kPoses_us, poses.header.frame_id));
  }
  for (const std::uint64_t lap : {0, 1, 1000, 36'000}) {
    const auto x_at = [&](std::int64_t since_first_ns) {
      msg::CameraFrame frame;
      frame.header.origin_ns = due_ns(kPoses_us, lap * kPoses_us.size()) + since_first_ns;
      return (*detector)->detect(frame, {}, Deadline::now())->hands[0].points[0].x_px;
    };
    EXPECT_EQ(x_at(to_ns(12ms)), 100) << "lap " << lap;
    EXPECT_EQ(x_at(to_ns(14ms)), 101) << "lap " << lap;
    EXPECT_EQ(x_at(to_ns(34ms)), 102) << "lap " << lap;
    EXPECT_EQ(x_at(to_ns(72ms)), 102) << "lap " << lap;
    EXPECT_EQ(x_at(to_ns(74ms)), 100) << "lap " << lap << ": the next one's is nearer";
  }
}

TEST_F(Replay, PicturesWithoutTimesBeginWithTheirFolder) {
  std::filesystem::remove(scratch_.path() / "camera_timestamps.npy");
  rig_.camera.rate_hz = 100;
  epoch_ns_ = now_ns();
  const auto camera = camera::open_camera(rig_, calibration_, epoch_ns_);
  ASSERT_TRUE(camera) << camera.error().what;
  constexpr std::int64_t kLapOfTheOthers_ns = 63'000'000;
  for (int i = 0; i < 4; ++i) {
    SmallFrame shot;
    ASSERT_TRUE((*camera)->capture(shot.frame, shot.pixels.size(), Deadline::in(5s)));
    const auto number = static_cast<std::int64_t>(shot.frame.header.frame_id);
    EXPECT_EQ(shot.frame.header.origin_ns,
              epoch_ns_ + number / 3 * kLapOfTheOthers_ns + number % 3 * to_ns(10ms));
  }
}

TEST_F(Replay, TimesOfTwoClocksAreRefusedWithTheFileNamed) {
  ASSERT_TRUE(recording::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy",
                                       {1'700'000'000'000'000, 1'700'000'000'010'000}));
  const auto pose = pose::open_pose_source(rig_, calibration_, epoch_ns_);
  ASSERT_FALSE(pose);
  EXPECT_EQ(pose.error().code, Errc::bad_config);
  EXPECT_THAT(pose.error().what, testing::AllOf(testing::HasSubstr("landmarks_timestamps.npy"),
                                                testing::HasSubstr("one clock")));
}

/// A link to itself is a file that nobody may look into.
TEST_F(Replay, AFileThatMayNotBeLookedForIsASentenceNotAnException) {
  const auto complaint_with = [&](const char* name, const auto& open) {
    const auto file = scratch_.path() / name;
    std::filesystem::rename(file, scratch_.path() / "aside");
    std::filesystem::create_symlink(file, file);
    const auto opened = open(rig_, calibration_, epoch_ns_);
    std::filesystem::remove(file);
    std::filesystem::rename(scratch_.path() / "aside", file);
    return opened ? "none" : opened.error().what;
  };
  const auto names = [](const char* name) {
    return testing::HasSubstr(std::string(name) + "' exists: ");
  };
  const auto open_camera = [](const auto&... with) { return camera::open_camera(with...); };
  const auto open_pose = [](const auto&... with) { return pose::open_pose_source(with...); };
  const auto open_detector = [](const auto&... with) { return landmarks::open_detector(with...); };
  EXPECT_THAT(complaint_with("camera", open_camera), names("camera"));
  EXPECT_THAT(complaint_with("camera_timestamps.npy", open_camera), names("camera_timestamps.npy"));
  EXPECT_THAT(complaint_with("joints_left.npy", open_pose), names("joints_left.npy"));
  EXPECT_THAT(complaint_with("landmarks_left.npy", open_detector), names("landmarks_left.npy"));
}

}  // namespace
}  // namespace handcast
