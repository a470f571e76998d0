// SPDX-License-Identifier: Apache-2.0
#include "renderer/register/late_registration.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "renderer/predict/projected_pose.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kPeriod_ns = 9 * kMs, kAge_ns = 9 * kMs, kFrame_ns = 2 * kMs,
                       kLeg_ns = 5 * kMs;

/// One moving hand. Tracker samples come every 9 ms and are 9 ms old; images come every 2 ms.
class Scene {
 public:
  explicit Scene(std::function<glm::vec3(double)> moved_m, glm::vec2 image_off_px = {})
      : moved_m_(std::move(moved_m)),
        image_off_px_(image_off_px),
        track_({}, calibration_),
        late_({}, {}, calibration_) {}

  msg::HandPose pose_at(std::int64_t time_ns) const {
    return pose_of(Side::left, moved_m_(static_cast<double>(time_ns) * 1e-9));
  }
  LandmarkPoints truth(std::int64_t time_ns) const {
    return *project_landmarks(calibration_, pose_at(time_ns));
  }

  /// Runs up to `now_ns`. `seen`: the image of the last 12 ms instead of that of the hand, if
  /// given.
  RegisteredHand run(std::int64_t now_ns, const Image<std::uint8_t>* seen = nullptr) {
    RegisteredHand corrected;
    for (; now_ns_ <= now_ns; now_ns_ += kMs) {
      if (now_ns_ % kPeriod_ns == 0)
        track_.push(now_ns_, now_ns_ - kAge_ns, pose_at(now_ns_ - kAge_ns));
      const auto predicted = track_.predict(now_ns_, now_ns_ + kLeg_ns);
      if (!predicted) continue;
      tracker_ = predicted->posed.landmarks;
      const LateRegistration::Hand hand{Side::left, &track_, predicted->posed.landmarks, {}};
      if (now_ns_ % kFrame_ns == 0 && now_ns_ > now_ns - 30 * kMs)
        look(now_ns_ - kFrame_ns, hand, now_ns_ > now_ns - 12 * kMs ? seen : nullptr);
      corrected = late_.correct(hand, now_ns_ + kLeg_ns);
    }
    return corrected;
  }
  /// The tracker snaps a finger aside, and the next landmarks show that the hand rests as it was.
  RegisteredHand snap() {
    const std::int64_t origin_ns = track_.newest_ns() + kPeriod_ns, target_ns = now_ns_ + kLeg_ns;
    msg::HandPose snapped = pose_at(origin_ns);
    for (std::size_t joint = 13; joint < 16; ++joint) snapped.joints[joint].position_m[0] += 0.01f;
    track_.push(now_ns_, origin_ns, snapped);
    track_.rest({origin_ns, 1}, target_ns);
    tracker_ = track_.predict(now_ns_, target_ns)->posed.landmarks;
    LandmarkPoints offset_px;
    for (int i = 0; i < kLandmarks; ++i) offset_px[i] = truth(target_ns)[i] - tracker_[i];
    return late_.correct({Side::left, &track_, tracker_, offset_px}, target_ns);
  }
  const LandmarkPoints& tracker() const { return tracker_; }
  const Registered& last() const { return late_.last(Side::left); }

 private:
  void look(std::int64_t camera_ns, const LateRegistration::Hand& hand,
            const Image<std::uint8_t>* seen) {
    const auto image = seen ? *seen : image_of(calibration_, {pose_at(camera_ns)}, image_off_px_);
    Image<std::uint8_t> mask(image.width(), image.height());
    for (std::size_t i = 0; i < mask.pixels().size(); ++i)
      mask.pixels()[i] = image.pixels()[i] > 79 ? 255 : 0;
    late_.look({image.view(), camera_ns, mask.view(), {0, 0, image.width(), image.height()}, 79},
               std::span(&hand, 1));
  }

  calib::Calibration calibration_ = rig_above_hand();
  std::function<glm::vec3(double)> moved_m_;
  glm::vec2 image_off_px_;
  HandTrack track_;
  LateRegistration late_;
  std::int64_t now_ns_ = 9 * kMs;
  LandmarkPoints tracker_{};
};

double mean_distance(const LandmarkPoints& a, const LandmarkPoints& b) {
  double sum = 0;
  for (int i = 0; i < kLandmarks; ++i) sum += glm::distance(a[i], b[i]) / kLandmarks;
  return sum;
}

constexpr std::int64_t kNow_ns = 151 * kMs;  // long after a sample, so the prediction is long

/// A hand that rests, and starts to move after the newest sample.
glm::vec3 starting(double s) {
  return {s > 0.138 ? static_cast<float>(30 * (s - 0.138) * (s - 0.138)) : 0, 0, 0};
}

TEST(LateRegistration, AMotionThatTheTrackerHasNotSeenYetIsFollowed) {
  Scene scene(starting);
  const auto corrected = scene.run(kNow_ns);
  const LandmarkPoints truth = scene.truth(kNow_ns + kLeg_ns);
  ASSERT_TRUE(scene.last().found);
  EXPECT_GT(mean_distance(scene.tracker(), truth), 9);
  EXPECT_LT(mean_distance(corrected.landmarks, truth),
            0.65 * mean_distance(scene.tracker(), truth));
  // The error grows from the exposure to the target time.
  EXPECT_GT(corrected.moved_now[9].x, corrected.moved_then[9].x);
}

TEST(LateRegistration, AStillHandStaysWhereTheTrackerHasItHoweverFarOffTheMaskIs) {
  Scene scene([](double) { return glm::vec3(0); }, {9, -5});
  for (std::int64_t now_ns = 60 * kMs; now_ns < 400 * kMs; now_ns += 40 * kMs) {
    const auto corrected = scene.run(now_ns);
    EXPECT_LT(mean_distance(corrected.landmarks, scene.tracker()), 0.01) << now_ns;
    EXPECT_TRUE(scene.last().found);
  }
}

TEST(LateRegistration, AHandAtRestIsNotMovedByASnapOfItsTrackerThatIsKnown) {
  Scene scene([](double) { return glm::vec3(0); });
  scene.run(kNow_ns);
  ASSERT_TRUE(scene.last().found);
  const auto corrected = scene.snap();
  EXPECT_GT(mean_distance(scene.tracker(), scene.truth(kNow_ns)), 0.8);
  EXPECT_LT(mean_distance(corrected.landmarks, scene.truth(kNow_ns)), 0.1);
}

TEST(LateRegistration, ASteadyMotionLeavesNothingBehindHoweverLong) {
  Scene scene([](double s) { return glm::vec3(0.25f * static_cast<float>(s) - 0.05f, 0, 0); });
  for (std::int64_t now_ns = 60 * kMs; now_ns < 400 * kMs; now_ns += 50 * kMs) {
    const auto corrected = scene.run(now_ns);
    EXPECT_LT(mean_distance(corrected.landmarks, scene.truth(now_ns + kLeg_ns)), 0.25) << now_ns;
  }
}

TEST(LateRegistration, AnImageOfSomethingElseCorrectsNothing) {
  Image<std::uint8_t> noise(720, 540, 8), dark(720, 540, 8), bright(720, 540, 200);
  unsigned state = 1;
  for (std::uint8_t& pixel : noise.pixels())
    pixel = (state = state * 1664525u + 1013904223u) >> 31 ? 200 : 8;
  for (const Image<std::uint8_t>* garbage : {&noise, &dark, &bright}) {
    Scene scene(starting);
    const auto corrected = scene.run(kNow_ns, garbage);
    EXPECT_FALSE(scene.last().found);
    EXPECT_LT(mean_distance(corrected.landmarks, scene.tracker()), 0.6);
  }
}

TEST(LateRegistration, SwitchedOffItLeavesTheLandmarksAlone) {
  const auto calibration = rig_above_hand();
  config::Registration none;
  none.method = config::RegisterMethod::none;
  EXPECT_FALSE(LateRegistration(none, {}, calibration).on());
}

}  // namespace
}  // namespace handcast::renderer
