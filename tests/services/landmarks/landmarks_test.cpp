// SPDX-License-Identifier: Apache-2.0
// The contract of every detector, and the twin's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <span>

#include "services/lab/training/trial.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#include "tests/scratch.hpp"
#include "tests/services/guest_ring.hpp"
#include "tests/services/landmarks/detector_scenes.hpp"
#include "tests/services/unread_settings.hpp"

namespace handcast::landmarks {
namespace {

using namespace std::chrono_literals;

bool is_landmark_model(std::string_view backend) {
  const auto models = landmark_models();
  return std::ranges::find(models, backend, &LandmarkModelRow::name) != models.end();
}

class DetectorContract : public testing::TestWithParam<std::string_view> {
 protected:
  void SetUp() override {
    if (GetParam() == "mediapipe") SKIP_WITHOUT_MODELS();
    if (is_landmark_model(GetParam())) {
      auto shown = training::Trials::open("builtin:open_close", 1)->make(1, 10).value();
      scene_.emplace(test::Capture{std::move(shown.image), shown.tracker_px});
    }
    rig_.landmarks.backend = GetParam();
    rig_.landmarks.models = test::models();
    rig_.landmarks.replay.directory = scratch_.path();
    write_detections(scratch_.path(), 4);
    open(rig_);
  }

  void open(const config::Rig& rig) {
    auto opened =
        open_detector(rig, scene_ ? scene_->calibration : calib::reference_rig(), epoch_ns_);
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

// Not compared: the duration of a detection, what happens to a second hand or one that the tracker
// does not see.
TEST_P(DetectorContract, LandmarksDependOnlyOnTheSettingsThatTheirRowNames) {
  const auto backends = detector_backends();
  const auto row = std::ranges::find(backends, GetParam(), &DetectorBackend::name);
  rig_.twin.motion = "builtin:two_hands";
  const std::int64_t origin_ns = epoch_ns_ + to_ns(300ms);
  const auto first_landmarks = [&](const config::Rig& rig) {
    open(rig);
    return detect(1, origin_ns, Deadline::in(10s));
  };
  const auto landmarks = first_landmarks(rig_);
  const auto other = first_landmarks(test::with_unread_settings_changed(rig_, "landmarks", *row));
  ASSERT_TRUE(landmarks && other);
  const auto bytes = [](const msg::Landmarks& of) { return std::as_bytes(std::span(&of, 1)); };
  EXPECT_TRUE(std::ranges::equal(bytes(*landmarks), bytes(*other)))
      << "a setting is missing in the row's `reads`";
}

/// All but `external`, whose landmarks are of the images that a program has searched.
std::vector<std::string_view> detectors_of_the_rig() {
  auto names = service::names_of(detector_backends());
  std::erase(names, "external");
  return names;
}

INSTANTIATE_TEST_SUITE_P(Backends, DetectorContract, testing::ValuesIn(detectors_of_the_rig()),
                         [](const auto& named) { return std::string(named.param); });

TEST(ExternalDetector, RemovesTheDistortionOfTheLensFromWhatAProgramSends) {
  test::GuestRing<msg::Landmarks> program("guest.landmarks");
  config::Rig rig;
  rig.landmarks.backend = "external";
  auto calibration = calib::reference_rig();
  calibration.camera.k1 = -0.3;
  const auto detector = open_detector(rig, calibration, now_ns(), {}, program.open());
  ASSERT_TRUE(detector) << detector.error().what;
  const auto first = (*detector)->detect(frame_of(6, 5), {}, Deadline::in(1ms));
  ASSERT_TRUE(first) << "the rig waits for a first result";
  EXPECT_EQ(first->header.frame_id, 6u);
  EXPECT_EQ(first->count, 0u);
  const auto silence = (*detector)->detect(frame_of(8, now_ns()), {}, Deadline::in(1ms));
  ASSERT_FALSE(silence);
  EXPECT_EQ(silence.error().code, Errc::timeout);

  const auto image = calibration.camera.distort({10, 20});
  msg::Landmarks sent;
  sent.header = {7, now_ns(), 0};
  sent.count = 1;
  sent.hands[0].presence = 1;
  sent.hands[0].points[4] = {static_cast<float>(image.x), static_cast<float>(image.y), 1, 2};
  program.send(sent);
  const auto found = (*detector)->detect(frame_of(8, now_ns()), {}, Deadline::in(5s));
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(found->header.frame_id, 7u) << "the image that the program searched";
  EXPECT_EQ(found->header.origin_ns, sent.header.origin_ns);
  EXPECT_NEAR(found->hands[0].points[4].x_px, 10, 0.01);
  EXPECT_NEAR(found->hands[0].points[4].y_px, 20, 0.01);
  EXPECT_GT(std::abs(image.x - 10), 1) << "the lens must distort";
}

TEST(ExternalDetector, ThatOfTheSecondCameraHasARingOfItsOwn) {
  test::GuestRing<msg::Landmarks> program("guest.landmarks2");
  config::Rig rig;
  rig.landmarks2.backend = "external";
  auto calibration = calib::reference_rig();
  calibration.camera2 = calib::SecondCamera{{}, calibration.camera, glm::dmat4(1)};
  std::string asked;
  const auto detector =
      open_detector(rig, calibration, 0, config::Viewpoint::second, [&](std::string_view stream) {
        asked = stream;
        return program.open()(stream);
      });
  ASSERT_TRUE(detector) << detector.error().what;
  EXPECT_EQ(asked, "guest.landmarks2");
}

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

}  // namespace
}  // namespace handcast::landmarks
