// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/known_errors.hpp"

#include <gtest/gtest.h>

#include "renderer/predict/projected_pose.hpp"
#include "tests/renderer/hand_pose.hpp"
#include "tests/renderer/poses.hpp"

/// @file
/// A still hand, seen exactly 100 times a second, that its tracker reports beside its place.

namespace handcast::renderer {
namespace {

class Known : public ::testing::Test {
 protected:
  /// Adds what is seen of the hand now, and the tracker's hand so far to the side.
  bool add(double aside_m) {
    time_ns_ += 10'000'000;
    Sighting sighting{time_ns_, in_camera(calibration_, pose_), seen_, {}};
    for (auto& at_m : sighting.reported.at_m) at_m.x += aside_m;
    return known_.add(calibration_.camera, sighting);
  }
  double shift_m() const { return known_.errors_at(time_ns_)[error::kShift]; }

  /// A second and a half in which the tracker loses the hand, a millimetre at a time.
  void lose_the_hand() {
    for (int i = 0; i < 150; ++i) ASSERT_TRUE(add(-1e-3 * i)) << i;
  }

  const calib::Calibration calibration_ = [] {
    calib::Calibration calibration;
    calibration.camera_from_tracker =
        glm::dmat4({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0.05, 0.6, 1});
    return calibration;
  }();
  const msg::HandPose pose_ =
      pose_of(Side::left, samples::posed(*load_hand_or_default({}, Side::left), samples::kPinch));
  const msg::HandLandmarks seen_ = [this] {
    const auto px = project_landmarks(calibration_, pose_).value();
    msg::HandLandmarks seen;
    for (int i = 0; i < kLandmarks; ++i) seen.points[i] = {px[i].x, px[i].y, 1, 2};
    return seen;
  }();
  std::int64_t time_ns_ = 0;
  KnownErrors known_;
};

TEST_F(Known, WhatWasKnownBeforeALossHoldsAfterIt) {
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(add(0));
  lose_the_hand();
  EXPECT_GT(shift_m(), 0.08);
  int sightings = 1;
  while (!add(0)) ++sightings;
  EXPECT_LE(sightings, 3);
  EXPECT_LT(std::abs(shift_m()), 0.02);
}

TEST_F(Known, ATrackerThatWasMovedContradictsUntilItIsDoubted) {
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(add(0));
  for (int i = 0; i < 100; ++i) ASSERT_FALSE(add(-0.08)) << i;
  known_.doubt_place();
  int sightings = 1;
  while (!add(-0.08)) ++sightings;
  EXPECT_LE(sightings, 3);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(add(-0.08));
  EXPECT_NEAR(shift_m(), 0.08, 0.02);
}

}  // namespace
}  // namespace handcast::renderer
