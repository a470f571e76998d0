// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/finger_snaps.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <optional>

#include "renderer/base/joint_math.hpp"
#include "tests/milliseconds.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::renderer {
namespace {

constexpr int kIndex = 7, kTip = 10;  ///< joints of the index finger

/// An open left hand at `moved_m`, whose index finger is bent at the knuckle.
msg::HandPose hand(float bent_deg, glm::vec3 moved_m = {}) {
  auto pose = pose_of(Side::left, moved_m);
  const glm::vec3 knuckle = position(pose.joints[kIndex]);
  const glm::vec3 axis = orientation(pose.joints[kIndex]) * glm::vec3(1, 0, 0);
  const glm::quat turn = glm::angleAxis(glm::radians(-bent_deg), axis);
  for (int j = kIndex; j <= kTip; ++j)
    place(pose.joints[j], knuckle + turn * (position(pose.joints[j]) - knuckle),
          turn * orientation(pose.joints[j]));
  return pose;
}

float tip_apart_m(const msg::HandPose& a, const msg::HandPose& b) {
  return glm::distance(position(a.joints[kTip]), position(b.joints[kTip]));
}

/// A tracker with 100 samples a second, and landmarks of an image 8 ms after each of them, which
/// are 7 px beside the tracker's joints, 60 px on the finger. Tests set how far it is bent.
class Fingers {
 public:
  std::function<float(std::int64_t ms)> tracked_deg = [](std::int64_t) { return 0.0f; };
  std::function<std::optional<float>(std::int64_t ms)> seen_deg = [](std::int64_t) { return 0.0f; };
  std::function<glm::vec3(std::int64_t ms)> way = [](std::int64_t) { return glm::vec3(0); };
  std::function<bool(std::int64_t ms)> samples = [](std::int64_t) { return true; };

  /// How far the tip of the sample of `last_ms` is from where the landmarks have it, m.
  float tip_off_m(std::int64_t last_ms) {
    FingerSnaps snaps(calibration_);
    std::optional<msg::HandPose> held;
    for (std::int64_t ms = 0; ms <= last_ms; ms += 10) {
      if (const auto deg = seen_deg(ms + 8)) {
        auto seen = landmarks_of(calibration_, (ms + 8) * kMs, hand(*deg, way(ms + 8)), {0, 0});
        for (int i = 0; i < kLandmarks; ++i) seen.hands[0].points[i].x_px += beside_px(i);
        snaps.detection((ms + 8) * kMs, seen.hands[0]);
      }
      if (samples(ms)) held = snaps.held(ms * kMs, hand(tracked_deg(ms), way(ms)), moved_px());
    }
    return tip_apart_m(*held, hand(seen_deg(last_ms).value_or(0), way(last_ms)));
  }

 private:
  static float beside_px(int landmark) { return landmark > 5 && landmark <= 8 ? 60 : 7; }
  static LandmarkPoints moved_px() {
    LandmarkPoints moved_px;
    for (int i = 0; i < kLandmarks; ++i) moved_px[i] = {beside_px(i), 0};
    return moved_px;
  }

  calib::Calibration calibration_ = rig_above_hand();
};

/// Of 25 degrees, from 200 to 400 ms.
float snap(std::int64_t ms) { return ms >= 200 && ms < 400 ? 25 : 0; }

TEST(FingerSnaps, AFingerThatSnapsWhileItsLandmarksRestIsHeld) {
  Fingers fingers;
  fingers.tracked_deg = snap;
  ASSERT_GT(tip_apart_m(hand(0), hand(25)), 0.02f);
  for (const int ms : {190, 200, 210, 390, 400, 410})
    EXPECT_LT(fingers.tip_off_m(ms), 1e-4f) << ms << " ms";
}

TEST(FingerSnaps, AHeldFingerGoesWithItsHand) {
  Fingers fingers;
  fingers.tracked_deg = snap;
  // Faster than a hand: what the image shows of it must not count.
  fingers.way = [](std::int64_t ms) { return glm::vec3(0, 0, 8e-3f * static_cast<float>(ms)); };
  for (const int ms : {200, 300, 390}) EXPECT_LT(fingers.tip_off_m(ms), 1e-4f) << ms << " ms";
}

TEST(FingerSnaps, AFingerThatMovesIsNotHeld) {
  Fingers fingers;
  fingers.tracked_deg = snap;
  fingers.seen_deg = snap;
  for (const int ms : {200, 210, 390, 400}) EXPECT_LT(fingers.tip_off_m(ms), 1e-4f) << ms << " ms";
}

TEST(FingerSnaps, AFingerThatMovesFastIsNotHeldByLandmarksThatLag) {
  Fingers fingers;
  fingers.tracked_deg = [](std::int64_t ms) {
    return ms < 200 ? 0 : 1.3e-2f * static_cast<float>((ms - 200) * (ms - 200));
  };
  fingers.seen_deg = [&](std::int64_t ms) { return fingers.tracked_deg(ms - 18); };
  for (const int ms : {220, 230, 240, 250}) {
    const auto lag_m = tip_apart_m(hand(fingers.tracked_deg(ms)), hand(*fingers.seen_deg(ms)));
    EXPECT_NEAR(fingers.tip_off_m(ms), lag_m, 1e-4f) << ms << " ms";
  }
}

TEST(FingerSnaps, AFingerThatMovesLessThanTheTrackerSaysIsNotHeld) {
  Fingers fingers;
  fingers.tracked_deg = snap;
  fingers.seen_deg = [](std::int64_t ms) { return ms < 208 ? 0 : 15; };
  EXPECT_NEAR(fingers.tip_off_m(300), tip_apart_m(hand(25), hand(15)), 1e-4f);
}

TEST(FingerSnaps, AFingerThatMovesAfterItsSnapIsLetGo) {
  Fingers fingers;
  fingers.tracked_deg = [](std::int64_t ms) { return ms < 200 ? 0.0f : ms < 300 ? 25.0f : 30.0f; };
  fingers.seen_deg = [](std::int64_t ms) { return ms < 300 ? 0.0f : 30.0f; };
  EXPECT_LT(fingers.tip_off_m(290), 1e-4f);
  EXPECT_LT(fingers.tip_off_m(310), 1e-4f);
}

TEST(FingerSnaps, ATrackerThatInsistsIsBelievedAfterHalfASecond) {
  Fingers fingers;
  fingers.tracked_deg = [](std::int64_t ms) { return ms < 200 ? 0.0f : 25.0f; };
  EXPECT_LT(fingers.tip_off_m(690), 1e-4f);
  EXPECT_GT(fingers.tip_off_m(720), 0.02f);
}

TEST(FingerSnaps, WithoutLandmarksTheTrackerIsBelieved) {
  Fingers fingers;
  fingers.tracked_deg = snap;
  fingers.seen_deg = [](std::int64_t ms) { return ms < 190 ? std::optional(0.0f) : std::nullopt; };
  EXPECT_GT(fingers.tip_off_m(300), 0.02f);
}

TEST(FingerSnaps, LandmarksOlderThanTheSnapSayNothing) {
  Fingers fingers;
  fingers.tracked_deg = snap;
  fingers.seen_deg = [](std::int64_t ms) {
    return ms < 190 || ms > 230 ? std::optional(0.0f) : std::nullopt;
  };
  for (const int ms : {200, 220, 300}) EXPECT_GT(fingers.tip_off_m(ms), 0.02f) << ms << " ms";
}

TEST(FingerSnaps, AFingerThatTheTrackerTakesForItsNeighbourIsNotHeldOnAWrongKnuckle) {
  FingerSnaps snaps(rig_above_hand());
  const auto seen = landmarks_of(rig_above_hand(), 12 * kMs, hand(0), {0, 0}).hands[0];
  auto wrong = hand(0);
  for (int k = 0; k < 4; ++k) wrong.joints[kIndex + 5 + k] = wrong.joints[kIndex + 10 + k];
  for (int ms = 0; ms < 100; ms += 10) snaps.held(ms * kMs, hand(0), {});
  snaps.detection(102 * kMs, seen);
  const auto held = snaps.held(100 * kMs, wrong, {});
  for (int j = kIndex + 5; j < kIndex + 9; ++j)
    EXPECT_LT(glm::distance(position(held.joints[j]), position(wrong.joints[j])), 1e-6f);
}

TEST(FingerSnaps, AfterAGapOfTheTrackerAFingerMayBeAnywhere) {
  Fingers fingers;
  fingers.tracked_deg = snap;
  fingers.samples = [](std::int64_t ms) { return ms < 130 || ms >= 200; };
  EXPECT_GT(fingers.tip_off_m(300), 0.02f);
}

TEST(FingerSnaps, AFingerThatIsNearlyBackIsLetGo) {
  Fingers fingers;
  fingers.tracked_deg = [](std::int64_t ms) { return ms < 200 ? 0.0f : ms < 300 ? 25.0f : 5.0f; };
  EXPECT_LT(fingers.tip_off_m(290), 1e-4f);
  EXPECT_NEAR(fingers.tip_off_m(310), tip_apart_m(hand(5), hand(0)), 1e-4f);
}

/// A tracker and an image that have shown a resting hand for 100 ms.
FingerSnaps after_rest() {
  FingerSnaps snaps(rig_above_hand());
  for (int ms = 0; ms < 100; ms += 10) snaps.held(ms * kMs, hand(0), {});
  snaps.detection(102 * kMs, landmarks_of(rig_above_hand(), 102 * kMs, hand(0), {0, 0}).hands[0]);
  return snaps;
}

TEST(FingerSnaps, AStepThatTheImageWouldHardlyShowIsNotHeld) {
  auto raised = hand(0);
  for (int j = kIndex + 1; j <= kTip; ++j) raised.joints[j].position_m[1] += 0.01f;
  EXPECT_LT(tip_apart_m(after_rest().held(100 * kMs, raised, {}), raised), 1e-6f);
}

TEST(FingerSnaps, AnImageThatComesLateDoesNotReplaceANewerOne) {
  auto snaps = after_rest();
  snaps.detection(50 * kMs, landmarks_of(rig_above_hand(), 50 * kMs, hand(25), {0, 0}).hands[0]);
  EXPECT_LT(tip_apart_m(snaps.held(100 * kMs, hand(25), {}), hand(0)), 1e-4f);
}

TEST(FingerSnaps, NothingIsHeldAfterAllWasForgotten) {
  auto snaps = after_rest();
  ASSERT_LT(tip_apart_m(snaps.held(100 * kMs, hand(25), {}), hand(0)), 1e-4f);
  snaps.forget();
  EXPECT_EQ(tip_apart_m(snaps.held(110 * kMs, hand(25), {}), hand(25)), 0);
}

TEST(FingerSnaps, BrokenAndOldSamplesChangeNothing) {
  FingerSnaps snaps(rig_above_hand());
  LandmarkPoints moved_px{};
  auto broken = hand(0);
  broken.joints[1].position_m[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(tip_apart_m(snaps.held(0, broken, moved_px), hand(0)), 0);
  EXPECT_EQ(tip_apart_m(snaps.held(10 * kMs, hand(0), moved_px), hand(0)), 0);
  for (const int ms : {20, 30}) snaps.held(ms * kMs, hand(0), moved_px);
  snaps.detection(32 * kMs, landmarks_of(rig_above_hand(), 32 * kMs, hand(0), {0, 0}).hands[0]);
  EXPECT_EQ(tip_apart_m(snaps.held(25 * kMs, hand(25), moved_px), hand(25)), 0);
}

}  // namespace
}  // namespace handcast::renderer
