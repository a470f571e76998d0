// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/auto_capture.hpp"

#include <gtest/gtest.h>

#include "tests/calib/solve/lens/synthetic_views.hpp"

namespace handcast::calib {
namespace {

constexpr Board kBoard{BoardKind::charuco, 10, 7, 20};
constexpr std::int64_t kFrame_ns = 50'000'000;

/// Holds a board in front of the camera, with a finder's noise, at 20 images a second.
class Hand {
 public:
  /// Number of views taken in a second.
  int hold(glm::dvec3 middle_m, glm::dvec2 tilt_rad = {0, 0}, glm::dvec3 step_m = {0, 0, 0}) {
    int taken = 0;
    for (int i = 0; i < 20; ++i, middle_m += step_m, time_ns_ += kFrame_ns)
      taken += capture_.take(time_ns_, view_of(kBoard, CameraModel{},
                                               held(kBoard, middle_m, tilt_rad), 0.05, random_));
    return taken;
  }
  void wait(std::int64_t ns) { time_ns_ += ns; }
  std::int64_t time_ns_ = 1;

 private:
  AutoCapture capture_{720};
  std::mt19937 random_{1};
};

TEST(AutoCapture, TakesOneViewOfABoardThatIsStill) {
  Hand hand;
  EXPECT_EQ(hand.hold({0, 0, 0.5}), 1);
  EXPECT_EQ(hand.hold({0, 0, 0.5}), 0) << "it has that view";
}

TEST(AutoCapture, TakesNothingWhileTheBoardMoves) {
  Hand hand;
  EXPECT_EQ(hand.hold({0, 0, 0.5}, {0, 0}, {0.0005, 0, 0}), 0);
}

TEST(AutoCapture, SlowDriftIsMotionToo) {
  Hand hand;
  // 0.12 px from image to image, 0.7 px in 0.3 s.
  EXPECT_EQ(hand.hold({0, 0, 0.5}, {0, 0}, {0.00005, 0, 0}), 0);
}

TEST(AutoCapture, ViewsInOtherPlacesAndOtherTiltsAreNew) {
  Hand hand;
  EXPECT_EQ(hand.hold({0, 0, 0.5}), 1);
  EXPECT_EQ(hand.hold({0.05, 0, 0.5}), 1);
  EXPECT_EQ(hand.hold({0, 0, 0.5}, {0.4, 0}), 1);
  EXPECT_EQ(hand.hold({0, 0, 0.5}, {0, 0.4}), 1);
  EXPECT_EQ(hand.hold({0.002, 0, 0.5}), 0) << "almost where the first one was";
  EXPECT_EQ(hand.hold({0.05, 0, 0.5}), 0);
}

TEST(AutoCapture, NobodyKnowsWhetherItWasStillWhileItWasNotSeen) {
  Hand hand;
  AutoCapture capture(720);
  std::mt19937 random(1);
  const auto view = view_of(kBoard, CameraModel{}, held(kBoard, {0, 0, 0.5}, {0, 0}), 0, random);
  EXPECT_FALSE(capture.take(1, view));
  EXPECT_FALSE(capture.take(2'000'000'000, view));
  EXPECT_FALSE(capture.take(2'200'000'000, view));
  EXPECT_TRUE(capture.take(2'310'000'000, view));
}

TEST(AutoCapture, AClockThatGoesBackBeginsAnew) {
  AutoCapture capture(720);
  std::mt19937 random(1);
  const auto view = view_of(kBoard, CameraModel{}, held(kBoard, {0, 0, 0.5}, {0, 0}), 0, random);
  EXPECT_FALSE(capture.take(5'000'000'000, view));
  EXPECT_FALSE(capture.take(1'000'000'000, view));
  EXPECT_TRUE(capture.take(1'300'000'000, view));
}

TEST(AutoCapture, AnEmptyViewIsNeverTaken) {
  AutoCapture capture(720);
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(capture.take(i * kFrame_ns, {}));
}

TEST(AutoCapture, CornersThatComeAndGoDoNotCountAsMotion) {
  AutoCapture capture(720);
  std::mt19937 random(1);
  auto view = view_of(kBoard, CameraModel{}, held(kBoard, {0, 0, 0.5}, {0, 0}), 0, random);
  EXPECT_FALSE(capture.take(0, view));
  view.ids.erase(view.ids.begin() + 2);
  view.image_px.erase(view.image_px.begin() + 2);
  view.board_m.erase(view.board_m.begin() + 2);
  EXPECT_TRUE(capture.take(300'000'000, view));
}

}  // namespace
}  // namespace handcast::calib
