// SPDX-License-Identifier: Apache-2.0
// The contract of every detector back end, and what is special to one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "ipc/msg/owned.hpp"
#include "services/evaluation/twin/recording.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/finder/hints.hpp"
#include "services/landmarks/training/trial.hpp"
#include "tests/scratch.hpp"
#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

using namespace std::chrono_literals;
constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

/// `count` detections of a left hand 10 ms apart; every coordinate of detection i is 100 + i.
void write_detections(const std::filesystem::path& folder, std::size_t count) {
  std::vector<float> values;
  std::vector<std::int64_t> times_us;
  for (std::size_t i = 0; i < count; ++i) {
    values.insert(values.end(), 42, static_cast<float>(100 + i));
    times_us.push_back(static_cast<std::int64_t>(i) * 10'000);
  }
  ASSERT_TRUE(twin::write_npy_f32(folder / "landmarks_left.npy", {count, 21, 2}, values));
  ASSERT_TRUE(twin::write_npy_i64(folder / "landmarks_timestamps.npy", times_us));
}

msg::CameraFrame frame_of(std::uint64_t id, std::int64_t origin_ns) {
  msg::CameraFrame frame;
  frame.header = {id, origin_ns, origin_ns};
  return frame;
}

bool runs_mediapipe(std::string_view backend) { return backend == "onednn" || backend == "opencv"; }

/// A real capture as the camera's, and a calibration for it.
struct Scene {
  msg::Owned<msg::CameraFrame> frame;
  calib::Calibration calibration = calib::reference_rig();
  Hints hints;

  explicit Scene(const test::Capture& capture)
      : frame(msg::CameraFrame::bytes(capture.image.width(), capture.image.height())),
        hints{capture.tracker_px, std::nullopt} {
    frame->width_px = capture.image.width();
    frame->height_px = capture.image.height();
    std::ranges::copy(capture.image.pixels(), frame->pixels());
    calibration.camera = {capture.image.width(), capture.image.height(), 1600, 1600, 511.5, 383.5};
  }
  const msg::CameraFrame& at(std::uint64_t id, std::int64_t origin_ns) {
    frame->header = {id, origin_ns, origin_ns};
    return *frame;
  }
};

class DetectorContract : public testing::TestWithParam<std::string_view> {
 protected:
  void SetUp() override {
    if (runs_mediapipe(GetParam())) {
      SKIP_WITHOUT_MODELS();
      SKIP_WITHOUT_CAPTURES();
      scene_.emplace(*test::capture(1));
    }
    if (GetParam() == "own") {
      auto shown = training::Trials::open("builtin:open_close", 1)->make(1, 10).value();
      scene_.emplace(test::Capture{std::move(shown.image), shown.tracker_px});
    }
    rig_.landmarks.backend = GetParam();
    rig_.landmarks.models = test::models();
    rig_.landmarks.replay.directory = scratch_.path();
    write_detections(scratch_.path(), 4);
    auto opened =
        open_detector(rig_, scene_ ? scene_->calibration : calib::reference_rig(), epoch_ns_);
    ASSERT_TRUE(opened) << opened.error().what;
    detector_ = std::move(*opened);
  }

  /// Of a frame with a left hand in it.
  Result<msg::Landmarks> detect(std::uint64_t id, std::int64_t origin_ns, Deadline deadline) {
    if (scene_) return detector_->detect(scene_->at(id, origin_ns), scene_->hints, deadline);
    return detector_->detect(frame_of(id, origin_ns), {}, deadline);
  }

  test::Scratch scratch_;
  config::Rig rig_;
  std::int64_t epoch_ns_ = now_ns();
  std::optional<Scene> scene_;
  std::unique_ptr<Detector> detector_;
};

TEST_P(DetectorContract, LandmarksCarryTheIdAndOriginOfTheirFrame) {
  for (std::uint64_t id = 1; id < 4; ++id) {
    const std::int64_t origin_ns = now_ns();
    const auto found = detect(id, origin_ns, Deadline::in(5s));
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_EQ(found->header.frame_id, id);
    EXPECT_EQ(found->header.origin_ns, origin_ns);
    ASSERT_EQ(found->count, 1u);
    EXPECT_EQ(found->hands[0].side, msg::Side::left);
    EXPECT_GT(found->hands[0].points[0].confidence, 0);
  }
}

TEST_P(DetectorContract, ADetectionNotDoneInTimeIsATimeoutAndGoesOn) {
  const std::int64_t origin_ns = now_ns();
  auto found = detect(1, origin_ns, Deadline::now());
  if (found) return;  // a back end that is done in the call
  EXPECT_EQ(found.error().code, Errc::timeout);
  found = detect(2, now_ns(), Deadline::in(5s));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->header.frame_id, 1u) << "the detection under way is that of the first frame";
  EXPECT_EQ(found->header.origin_ns, origin_ns);
}

std::vector<std::string_view> all() { return service::names_of(detector_backends()); }
INSTANTIATE_TEST_SUITE_P(Backends, DetectorContract, testing::ValuesIn(all()),
                         [](const auto& named) { return std::string(named.param); });

TEST(TwinDetector, TakesAsLongAsTheRigSays) {
  config::Rig rig;
  rig.twin.detector.age_ms = 25;
  rig.twin.detector.age_sd_ms = 0;
  const auto detector = open_detector(rig, calib::reference_rig(), now_ns());
  ASSERT_TRUE(detector) << detector.error().what;
  const std::int64_t origin_ns = now_ns();
  ASSERT_TRUE((*detector)->detect(frame_of(0, origin_ns), {}, Deadline::in(5s)));
  EXPECT_GE(now_ns() - origin_ns, to_ns(25ms) - to_ns(1us));
}

TEST(TwinDetector, AnOldFrameTakesNoLessWorkThanAFreshOne) {
  config::Rig rig;
  rig.twin.detector.age_ms = 25;
  rig.twin.detector.age_sd_ms = 0;
  const auto detector = open_detector(rig, calib::reference_rig(), now_ns() - to_ns(2s));
  ASSERT_TRUE(detector) << detector.error().what;
  const std::int64_t begin_ns = now_ns();
  ASSERT_TRUE((*detector)->detect(frame_of(0, begin_ns - to_ns(1s)), {}, Deadline::in(5s)));
  EXPECT_GE(now_ns() - begin_ns, to_ns(20ms))
      << "25 ms less what a frame is old at most when it is taken";
}

class NetworkDetector : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_MODELS();
    SKIP_WITHOUT_CAPTURES();
    rig_.landmarks.backend = "opencv";
    rig_.landmarks.models = test::models();
    scene_.emplace(*test::capture(6));
  }
  msg::HandLandmarks detect() {
    const auto detector = open_detector(rig_, scene_->calibration, 0);
    EXPECT_TRUE(detector) << detector.error().what;
    const auto found = (*detector)->detect(scene_->at(1, 1), scene_->hints, Deadline::in(5s));
    EXPECT_TRUE(found && found->count == 1);
    return found->hands[0];
  }

  config::Rig rig_;
  std::optional<Scene> scene_;
};

TEST_F(NetworkDetector, LandmarksAreFreeOfTheLensesDistortion) {
  const msg::Landmark plain = detect().points[20];
  scene_->calibration.camera.k1 = -0.3;
  const Points hints =
      undistorted(scene_->calibration.camera,
                  *scene_->hints[0]);  // the joints stay where they are in the image
  scene_->hints[0] = hints;
  const msg::Landmark seen = detect().points[20];
  const glm::dvec2 expected = scene_->calibration.camera.undistort({plain.x_px, plain.y_px});
  EXPECT_NEAR(seen.x_px, expected.x, 0.5);
  EXPECT_NEAR(seen.y_px, expected.y, 0.5);
  EXPECT_GT(std::hypot(seen.x_px - plain.x_px, seen.y_px - plain.y_px), 2);
}

TEST_F(NetworkDetector, MovesTheThumbsKnuckleToTheTrackersJointUnlessToldNotTo) {
  const auto as_tracker = detect();
  rig_.landmarks.definition = config::LandmarkDefinition::network;
  const auto as_network = detect();
  const auto moved_px = [&](int i) {
    return std::hypot(as_tracker.points[i].x_px - as_network.points[i].x_px,
                      as_tracker.points[i].y_px - as_network.points[i].y_px);
  };
  EXPECT_GT(moved_px(2), 10);
  EXPECT_EQ(moved_px(8), 0);
}

TEST_F(NetworkDetector, MediaPipesNetworkSaysNoSigma) {
  for (const auto& point : detect().points) EXPECT_EQ(point.sigma_px, 0);
}

TEST_F(NetworkDetector, PointsBesideTheImageAreNotSeen) {
  const auto capture = *test::capture(6);
  test::Grey cut(700, 200);
  for (int y = 0; y < cut.height(); ++y) std::copy_n(capture.image.row(y), cut.width(), cut.row(y));
  Scene scene({cut, capture.tracker_px});
  const auto detector = open_detector(rig_, scene.calibration, 0);
  ASSERT_TRUE(detector) << detector.error().what;
  const auto found = (*detector)->detect(scene.at(1, 1), scene.hints, Deadline::in(5s));
  ASSERT_TRUE(found) << found.error().what;
  for (std::uint32_t i = 0; i < found->count; ++i)
    for (const auto& point : found->hands[i].points)
      EXPECT_TRUE(point.confidence == 0 || point.y_px < 199.5f + 20);
}

TEST_F(NetworkDetector, AnImageOfAnotherSizeIsLeftOut) {
  const auto detector = open_detector(rig_, scene_->calibration, 0);
  ASSERT_TRUE(detector) << detector.error().what;
  const auto found = (*detector)->detect(frame_of(1, 1), {}, Deadline::in(5s));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::bad_data);
  EXPECT_THAT(found.error().what,
              testing::HasSubstr("0 x 0 px, but the calibration is for a camera of 1024 x 768 px"));
}

void expect_refused(const std::filesystem::path& models, const std::string& sentence) {
  config::Rig rig;
  rig.landmarks.backend = "opencv";
  rig.landmarks.models = models;
  const auto opened = open_detector(rig, calib::reference_rig(), 0);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what, testing::HasSubstr(sentence));
}

TEST(NetworkDetectorFiles, SaysWhatItMisses) {
  const test::Scratch scratch;
  expect_refused(scratch.path(), "hand_landmark_lite.onnx' is missing; scripts/get-models");
}

TEST(NetworkDetectorFiles, OneNetworkIsNotTakenForTheOther) {
  SKIP_WITHOUT_MODELS();
  const test::Scratch scratch;
  std::filesystem::copy(test::models() / kPalmModel, scratch.path() / kHandModel);
  expect_refused(scratch.path(), "is not the hand landmark network: it takes 1x192x192x3");
}

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
  ASSERT_TRUE(twin::write_npy_f32(scratch_.path() / "landmarks_right.npy", {2, 21, 2}, values));
  ASSERT_TRUE(twin::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", {0, 10'000}));
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
  ASSERT_TRUE(twin::write_npy_f32(scratch_.path() / "landmarks_left.npy", {2, 21, 3}, values));
  ASSERT_TRUE(twin::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", {0, 10'000}));
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

TEST_F(ReplayDetector, SaysWhatItMisses) {
  expect_refused("landmarks_timestamps.npy");
  ASSERT_TRUE(twin::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", {0, 10'000}));
  expect_refused("neither");
}

TEST_F(ReplayDetector, SaysWhenTimesAndLandmarksDoNotPair) {
  write_detections(scratch_.path(), 4);
  ASSERT_TRUE(twin::write_npy_i64(scratch_.path() / "landmarks_timestamps.npy", {0, 10'000}));
  expect_refused("(4, 21, 2); expected (2, 21, 2) or, with sigmas, (2, 21, 3)");
}

}  // namespace
}  // namespace handcast::landmarks
