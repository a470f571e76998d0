// SPDX-License-Identifier: Apache-2.0
// The landmark models as detectors: lens, convention of the joints, confidence, missing files.
#include <gmock/gmock.h>

#include "services/lab/training/trial.hpp"
#include "services/landmarks/models/mediapipe_files.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"
#include "tests/scratch.hpp"
#include "tests/services/landmarks/detector_scenes.hpp"

namespace handcast::landmarks {
namespace {

using namespace std::chrono_literals;
using training::Trial;

Trial trial(int i) {
  static auto trials = training::Trials::open("builtin:open_close", 1);
  EXPECT_TRUE(trials) << trials.error().what;
  return trials->make(i, 960).value();
}

TEST(NetworkDetector, ACameraWhosePixelsAreNotSquareIsRefused) {
  config::Rig rig;
  rig.landmarks.backend = "handcast";
  auto calibration = calib::reference_rig();
  calibration.camera.fy_px *= 0.98;
  EXPECT_TRUE(open_detector(rig, calibration, 0));
  calibration.camera.fy_px = calibration.camera.fx_px / 2;
  const auto refused = open_detector(rig, calibration, 0);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::bad_config);
  EXPECT_THAT(refused.error().what, testing::HasSubstr("pixels are 2 times as high as wide"));
}

class MediapipeDetector : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_MODELS();
    SKIP_WITHOUT_CAPTURES();
    rig_.landmarks.backend = "mediapipe";
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

TEST_F(MediapipeDetector, LandmarksAreFreeOfTheLensesDistortion) {
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

TEST_F(MediapipeDetector, AllLandmarksHaveTheSameSigma) {
  const auto hand = detect();
  const float wrist_to_knuckle_px = std::hypot(hand.points[9].x_px - hand.points[0].x_px,
                                               hand.points[9].y_px - hand.points[0].y_px);
  // The region's side is about two and a half palms.
  EXPECT_NEAR(hand.points[0].sigma_px, 0.045 * 2.5 * wrist_to_knuckle_px,
              0.3 * hand.points[0].sigma_px);
  float surest = 0;
  for (const auto& point : hand.points) {
    EXPECT_EQ(point.sigma_px, hand.points[0].sigma_px);
    surest = std::max(surest, point.confidence);
  }
  EXPECT_GT(surest, 0.9f) << "the sigma says nothing of single landmarks";
}

TEST_F(MediapipeDetector, WithoutATrackerItsLandmarksHaveNoSigma) {
  rig_.pose.backend = "none";
  for (const auto& point : detect().points) EXPECT_EQ(point.sigma_px, 0);
}

TEST_F(MediapipeDetector, PointsBesideTheImageAreNotSeen) {
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

TEST_F(MediapipeDetector, AnImageOfAnotherSizeIsLeftOut) {
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
  rig.landmarks.backend = "mediapipe";
  rig.landmarks.models = models;
  const auto opened = open_detector(rig, calib::reference_rig(), 0);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what, testing::HasSubstr(sentence));
}

TEST(MediapipeDetectorFiles, SaysWhatItMisses) {
  const test::Scratch scratch;
  expect_refused(scratch.path(), "hand_landmark_lite.onnx' is missing; scripts/get-models");
}

TEST(MediapipeDetectorFiles, OneNetworkIsNotTakenForTheOther) {
  SKIP_WITHOUT_MODELS();
  const test::Scratch scratch;
  std::filesystem::copy(test::models() / kMediapipePalmFile, scratch.path() / kMediapipeHandFile);
  expect_refused(scratch.path(), "is not the hand landmark network: its inputs are 1x192x192x3");
}

/// The detector on one image whose tracker is right.
class HandcastDetector : public testing::Test {
 protected:
  msg::Landmarks detect(const test::Grey& image, const Points& tracker_px) {
    config::Rig rig;
    rig.landmarks.backend = "handcast";
    rig.landmarks.models = scratch_.path();
    const auto detector = open_detector(rig, calib::reference_rig(), 0);
    EXPECT_TRUE(detector) << detector.error().what;
    msg::Owned<msg::CameraFrame> frame(msg::CameraFrame::bytes(image.width(), image.height()));
    frame->width_px = image.width();
    frame->height_px = image.height();
    std::ranges::copy(image.pixels(), frame->pixels());
    const auto found = (*detector)->detect(
        *frame, Hints{undistorted(calib::reference_rig().camera, tracker_px), std::nullopt},
        Deadline::now());
    EXPECT_TRUE(found) << found.error().what;
    return *found;
  }
  float mean_confidence(const test::Grey& image, const Points& tracker_px) {
    const auto found = detect(image, tracker_px);
    float sum = 0;
    for (std::uint32_t i = 0; i < found.count; ++i)
      for (const auto& point : found.hands[i].points) sum += point.confidence / msg::kLandmarks;
    return sum;
  }
  test::Scratch scratch_;
};

TEST_F(HandcastDetector, ConfidenceFallsAsNoiseRises) {
  const Trial seen = trial(100);
  const auto noise = test::noise(720, 540);
  const auto noisy = [&](double share) {
    return mean_confidence(test::painted(720, 540,
                                         [&](int x, int y) {
                                           return (1 - share) * seen.image.at(x, y) +
                                                  share * noise.at(x, y);
                                         }),
                           seen.tracker_px);
  };
  const float clean = noisy(0), grainy = noisy(0.6), lost = noisy(0.95);
  // Its sigmas hold on flesh that the network has not seen; on this one they are larger than its
  // errors.
  EXPECT_GT(clean, 0.75f);
  EXPECT_LT(grainy, clean - 0.05f);
  EXPECT_LT(lost, grainy - 0.05f);
}

TEST_F(HandcastDetector, ALandmarkThatIsHiddenIsLessSureThanOneThatIsSeen) {
  const Trial seen = trial(0);
  const auto tip = static_cast<int>(seen.truth_px[12].y + 0.35f * palm_length_px(seen.truth_px));
  const auto found = detect(test::covered(seen.image, test::Hidden::above, tip), seen.tracker_px);
  ASSERT_EQ(found.count, 1u);
  EXPECT_LT(found.hands[0].points[12].confidence, found.hands[0].points[0].confidence - 0.1f);
}

TEST_F(HandcastDetector, ATrackersHandThatIsAPointOrFarAwayIsNoHand) {
  const Trial seen = trial(100);
  Points point;
  point.fill(seen.tracker_px[9]);
  EXPECT_EQ(detect(seen.image, point).count, 0u);
  EXPECT_EQ(detect(seen.image, shifted(seen.tracker_px, {3000, 0})).count, 0u);
}

TEST_F(HandcastDetector, SaysThatItsFileIsMissing) {
  const char* before = std::getenv("HANDCAST_ASSETS");
  const std::string kept = before ? before : "";
  setenv("HANDCAST_ASSETS", scratch_.path().c_str(), 1);
  config::Rig rig;
  rig.landmarks.backend = "handcast";
  const auto detector = open_detector(rig, calib::reference_rig(), 0);
  before ? setenv("HANDCAST_ASSETS", kept.c_str(), 1) : unsetenv("HANDCAST_ASSETS");
  ASSERT_FALSE(detector);
  EXPECT_EQ(detector.error().code, Errc::bad_config);
  EXPECT_THAT(detector.error().what,
              testing::AllOf(testing::HasSubstr(
                                 "landmarks/handcast.onnx', which comes with handcast, is missing"),
                             testing::Not(testing::HasSubstr("\n"))));
}

}  // namespace
}  // namespace handcast::landmarks
