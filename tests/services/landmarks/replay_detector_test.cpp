// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <limits>

#include "tests/scratch.hpp"
#include "tests/services/landmarks/detector_scenes.hpp"

namespace handcast::landmarks {
namespace {

using namespace std::chrono_literals;
constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

class ReplayDetector : public testing::Test {
 protected:
  ReplayDetector() {
    rig_.landmarks.backend = "replay";
    rig_.landmarks.replay.directory = scratch_.path();
  }
  Result<std::unique_ptr<Detector>> open() {
    return open_detector(rig_, calib::reference_rig(), kEpoch_ns);
  }
  void expect_refused(const std::string& part) {
    const auto opened = open();
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, Errc::bad_config);
    EXPECT_THAT(opened.error().what, testing::HasSubstr(part));
  }

  static constexpr std::int64_t kEpoch_ns = 1'000'000'000;
  test::Scratch scratch_;
  config::Rig rig_;
};

TEST_F(ReplayDetector, GivesTheDetectionNearestInTime) {
  write_detections(scratch_.path(), 4);  // a lap takes 40 ms
  const auto detector = open();
  ASSERT_TRUE(detector) << detector.error().what;
  const auto x_at = [&](std::int64_t since_epoch_ns) {
    return (*detector)
        ->detect(frame_of(0, kEpoch_ns + since_epoch_ns), {}, Deadline::now())
        ->hands[0]
        .points[20]
        .x_px;
  };
  EXPECT_EQ(x_at(to_ns(14ms)), 101);
  EXPECT_EQ(x_at(to_ns(16ms)), 102);
  EXPECT_EQ(x_at(to_ns(54ms)), 101);
  EXPECT_EQ(x_at(to_ns(39ms)), 100);
}

TEST_F(ReplayDetector, APointThatIsNotANumberWasNotSeen) {
  std::vector<float> values(2 * 42, 7);
  values[42] = kUnseen;                      // detection 1: its first point
  std::fill_n(values.begin(), 42, kUnseen);  // detection 0: the whole hand
  ASSERT_TRUE(
      recording::write_npy_f32(scratch_.path() / "landmarks_right.npy", {2, 21, 2}, values));
  ASSERT_TRUE(recording::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", {0, 10'000}));
  const auto detector = open();
  ASSERT_TRUE(detector) << detector.error().what;
  EXPECT_EQ((*detector)->detect(frame_of(0, kEpoch_ns), {}, Deadline::now())->count, 0u);
  const auto found = (*detector)->detect(frame_of(0, kEpoch_ns + to_ns(10ms)), {}, Deadline::now());
  ASSERT_EQ(found->count, 1u);
  EXPECT_EQ(found->hands[0].side, msg::Side::right);
  EXPECT_EQ(found->hands[0].points[0].confidence, 0);
  EXPECT_EQ(found->hands[0].points[1].confidence, 1);
}

TEST_F(ReplayDetector, GivesTheSigmasOfARecordingThatHasThem) {
  std::vector<float> values;
  for (int i = 0; i < 2 * msg::kLandmarks; ++i)
    values.insert(values.end(), {100, 200, 0.5f * static_cast<float>(i)});
  ASSERT_TRUE(recording::write_npy_f32(scratch_.path() / "landmarks_left.npy", {2, 21, 3}, values));
  ASSERT_TRUE(recording::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", {0, 10'000}));
  const auto detector = open();
  ASSERT_TRUE(detector) << detector.error().what;
  const auto found = (*detector)->detect(frame_of(0, kEpoch_ns + to_ns(10ms)), {}, Deadline::now());
  ASSERT_EQ(found->count, 1u);
  EXPECT_EQ(found->hands[0].points[4].x_px, 100);
  EXPECT_EQ(found->hands[0].points[4].y_px, 200);
  EXPECT_EQ(found->hands[0].points[4].sigma_px, 12.5f);
  write_detections(scratch_.path(), 4);
  EXPECT_EQ(
      (*open())->detect(frame_of(0, kEpoch_ns), {}, Deadline::now())->hands[0].points[4].sigma_px,
      0)
      << "one without";
}

TEST_F(ReplayDetector, ALandmarkThatWasNotSeenNeedsNoSigma) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> values{none, none, none};
  while (values.size() < 2 * msg::kLandmarks * 3) values.insert(values.end(), {100, 200, 1});
  ASSERT_TRUE(recording::write_npy_f32(scratch_.path() / "landmarks_left.npy", {2, 21, 3}, values));
  ASSERT_TRUE(recording::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", {0, 10'000}));
  EXPECT_TRUE(open()) << open().error().what;
  values[5] = none;  // of a landmark that was seen
  ASSERT_TRUE(recording::write_npy_f32(scratch_.path() / "landmarks_left.npy", {2, 21, 3}, values));
  EXPECT_FALSE(open());
}

TEST_F(ReplayDetector, SaysWhatItMisses) {
  expect_refused("landmarks_timestamps.npy");
  ASSERT_TRUE(recording::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", {0, 10'000}));
  expect_refused("neither");
}

TEST_F(ReplayDetector, SaysWhenTimesAndLandmarksDoNotPair) {
  write_detections(scratch_.path(), 4);
  ASSERT_TRUE(recording::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", {0, 10'000}));
  expect_refused("(4, 21, 2); expected (2, 21, 2) or, with sigmas, (2, 21, 3)");
}

}  // namespace
}  // namespace handcast::landmarks
