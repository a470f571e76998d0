// SPDX-License-Identifier: Apache-2.0
// Two hands that pass in front of each other, with detectors that see what a camera sees: of the
// hand behind, nothing, or the hand in front in its place.
#include <gtest/gtest.h>

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "tests/services/pose/stereo/two_views.hpp"

namespace handcast::pose::stereo {
namespace {

constexpr std::int64_t kCrossingStep_ns = 8'000'000;

/// What detectors report of a hand behind the other one.
enum class Behind { nothing, hand_in_front };

class CrossingTest : public testing::Test {
 protected:
  /// The reports of a view. A hand whose palm is nearer than this to that of the hand in front is
  /// hidden.
  msg::Landmarks seen(int view, std::int64_t time_ns, Behind behind) {
    constexpr double kHidden_px = 70;
    auto landmarks = world_.seen(view, time_ns);
    const auto depth_m = [&](const msg::HandLandmarks& hand) {
      const auto truth = world_.twin().joints(hand.side, time_ns).value();
      return glm::dvec4(world_.calibration().camera_from_tracker *
                        glm::dvec4(glm::dvec3(truth[kPalm][3]), 1))
          .z;
    };
    if (landmarks.count < 2) return landmarks;
    auto &a = landmarks.hands[0], &b = landmarks.hands[1];
    const bool first_is_behind = depth_m(a) > depth_m(b);
    auto& hidden = first_is_behind ? a : b;
    const auto& front = first_is_behind ? b : a;
    if (std::hypot(a.points[9].x_px - b.points[9].x_px, a.points[9].y_px - b.points[9].y_px) >
        kHidden_px)
      return landmarks;
    if (behind == Behind::hand_in_front) {
      for (std::size_t i = 0; i < hidden.points.size(); ++i) {
        hidden.points[i] = front.points[i];
        hidden.points[i].x_px += 3;  // two reports of one hand are never the same
      }
    } else {
      hidden = front;
      landmarks.count = 1;
    }
    return landmarks;
  }

  /// Follows the hands until `end_s`; returns the largest error of a pose with a confidence of at
  /// least `least`, mm, and counts the samples in which a hand had no pose.
  double worst_mm(double end_s, Behind behind, float least = 0.5f) {
    double worst = 0;
    missing_ = 0;
    for (std::int64_t time_ns = 0; time_ns < seconds_to_ns(end_s); time_ns += kCrossingStep_ns) {
      const auto here = seen(0, time_ns, behind), there = seen(1, time_ns, behind);
      const auto poses = world_.tracker().sample({&here, &there});
      missing_ += 2 - static_cast<int>(poses.count);
      for (std::uint32_t h = 0; h < poses.count; ++h)
        if (poses.hands[h].confidence >= least)
          worst = std::max(worst, world_.error_mm(poses.hands[h], time_ns));
    }
    return worst;
  }

  TwoViews world_{with_noise(2), "crossing"};
  int missing_ = 0;
};

/// mm. The worst error is 17. With the hand in front in place of the hidden one, it is 114 if
/// reports are matched without regard to where a hand is expected, and 150 if what is hidden is
/// fitted, too. A hidden hand that is not predicted is missing in 27 samples.
constexpr double kMost_mm = 30;

TEST_F(CrossingTest, AHandBehindTheOtherIsPredictedWhileNoDetectorSeesIt) {
  EXPECT_LT(worst_mm(2.5, Behind::nothing), kMost_mm) << "the other hand is 100 mm away";
  EXPECT_EQ(missing_, 0);
}

TEST_F(CrossingTest, AHandBehindTheOtherIsNotWhereDetectorsTakeTheOtherForIt) {
  EXPECT_LT(worst_mm(2.5, Behind::hand_in_front), kMost_mm) << "the other hand is 100 mm away";
  EXPECT_EQ(missing_, 0);
}

TEST_F(CrossingTest, AHandThatStaysHiddenLosesItsConfidenceAndThenItsPose) {
  float before = 1;
  int samples = 0, falls = 0;
  std::int64_t hidden_ns = -1;
  auto front = msg::Side::left;
  for (std::int64_t time_ns = 0; time_ns < 2'000'000'000; time_ns += kCrossingStep_ns) {
    auto here = seen(0, time_ns, Behind::nothing), there = seen(1, time_ns, Behind::nothing);
    if (hidden_ns < 0 && here.count == 1 && there.count == 1) hidden_ns = time_ns;
    if (hidden_ns == time_ns) front = here.hands[0].side;
    if (hidden_ns >= 0)  // the detectors do not find it again
      for (auto* view : {&here, &there}) {
        if (view->count == 2 && view->hands[1].side == front) view->hands[0] = view->hands[1];
        view->count = 1;
      }
    const auto poses = world_.tracker().sample({&here, &there});
    if (hidden_ns < 0) continue;
    const auto* pose = poses.find(front == msg::Side::left ? msg::Side::right : msg::Side::left);
    if (time_ns - hidden_ns > StereoHand::kForget_ns) {
      EXPECT_FALSE(pose) << "it is lost";
      continue;
    }
    if (!pose) continue;
    ++samples;
    falls += pose->confidence <= before ? 1 : 0;
    before = pose->confidence;
  }
  EXPECT_GT(samples, 10);
  EXPECT_EQ(falls, samples);
  EXPECT_LT(before, 0.1f);
}

}  // namespace
}  // namespace handcast::pose::stereo
