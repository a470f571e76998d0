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
  bool add(double aside_m, const Flexions& snapped_rad = {}, Abrupt abrupt = Abrupt::neither) {
    time_ns_ += 10'000'000;
    Sighting sighting{time_ns_, in_camera(calibration_, pose_), seen_, {}};
    sighting.abrupt.landmarks.fill(abrupt);
    sighting.abrupt.snapped_rad = snapped_rad;
    for (auto& at_m : sighting.reported.at_m) at_m.x += aside_m;
    return known_.add(calibration_.camera, sighting);
  }
  /// Adds that the detector sees the index finger beside its place, and whether it has just moved
  /// it.
  void see_index_beside(float beside_px, bool is_abrupt) {
    time_ns_ += 10'000'000;
    Sighting sighting{time_ns_, in_camera(calibration_, pose_), seen_, {}};
    for (int i = 5; i < 9; ++i) {
      sighting.seen.points[i].x_px += beside_px;
      if (is_abrupt) sighting.abrupt.landmarks[i] = Abrupt::detector;
    }
    EXPECT_TRUE(known_.add(calibration_.camera, sighting));
  }
  /// How far the index finger is believed to be from where the tracker has it, m.
  double index_moved_m() const {
    const auto errors = known_.errors_at(time_ns_);
    const auto reported = in_camera(calibration_, pose_);
    const ArticulatedHand hand(reported, errors);
    const auto tip = joint_of_landmark(8);
    return glm::distance(hand.joints().at_m[tip], reported.at_m[tip]);
  }
  /// How far the tip of the middle finger is believed to be from its place after two seconds in
  /// which the tracker has its two upper joints 6 cm beside them, m.
  double middle_off_m() {
    const auto truth = in_camera(calibration_, pose_);
    auto reported = truth;
    for (const int landmark : {11, 12}) reported.at_m[joint_of_landmark(landmark)].x += 0.06;
    for (int i = 0; i < 200; ++i) {
      time_ns_ += 10'000'000;
      known_.add(calibration_.camera, {time_ns_, reported, seen_, {}});
    }
    const auto tip = joint_of_landmark(12);
    const ArticulatedHand hand(reported, known_.errors_at(time_ns_));
    return glm::distance(hand.joints().at_m[tip], truth.at_m[tip]);
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
  msg::HandLandmarks seen_ = [this] {
    const auto px = project_landmarks(calibration_, pose_).value();
    msg::HandLandmarks seen;
    for (int i = 0; i < kLandmarks; ++i) seen.points[i] = {px[i].x, px[i].y, 1, 2};
    return seen;
  }();
  std::int64_t time_ns_ = 0;
  KnownErrors known_;
};

TEST_F(Known, ALandmarkOutsideOfTheImageDoesNotMakeTheOthersOutliers) {
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(add(0));
  seen_.points[8] = {};
  EXPECT_LT(middle_off_m(), 0.012) << "of 0.06";
}

TEST_F(Known, WhatWasKnownBeforeALossHoldsAfterIt) {
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(add(0));
  lose_the_hand();
  EXPECT_GT(index_moved_m(), 0.12) << "of 0.15";
  int sightings = 1;
  while (!add(0)) ++sightings;
  EXPECT_LE(sightings, 3);
  EXPECT_LT(std::abs(shift_m()), 0.02);
}

// What lasts would be wrong for longer than the loss.
TEST_F(Known, OfTwoThatExplainAHandTheOneWithSmallerErrorsIsTaken) {
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(add(0));
  for (int i = 0; i < 150; ++i) ASSERT_TRUE(add(-0.4e-3 * i)) << i;
  EXPECT_GT(shift_m(), 0.03) << "of 0.06";
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(add(0, {}, i == 0 ? Abrupt::tracker : Abrupt::neither));
  EXPECT_LT(std::abs(shift_m()), 0.002);
}

// The tracker's return is no change that an estimate from before the loss has to undo.
TEST_F(Known, AnEarlierEstimateIsNotBentBack) {
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(add(0));
  lose_the_hand();
  Flexions returned_rad{};
  returned_rad[1].fill(0.4);
  while (!add(0, returned_rad)) continue;
  for (int b = 0; b < kBendsOfFinger; ++b)
    EXPECT_NEAR(known_.errors_at(time_ns_)[error::bend_of(1, b)], 0, 0.02) << b;
}

TEST_F(Known, AnErrorOfTheDetectorEndsAsAbruptlyAsItBegan) {
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(add(0));
  for (int i = 0; i < 60; ++i) see_index_beside(45 + 0.5f * static_cast<float>(i), i == 0);
  EXPECT_GT(index_moved_m(), 0.003) << "the part that came slowly is believed";
  for (int i = 0; i < 20; ++i) see_index_beside(0, i == 0);
  EXPECT_LT(index_moved_m(), 0.003);
}

// Or the joint would stay where only the tracker had it.
TEST_F(Known, ErrorsOfTrackerAndDetectorThatCancelAreForgotten) {
  const auto see_tip_beside = [&](double beside_m, Abrupt abrupt) {
    time_ns_ += 10'000'000;
    Sighting sighting{time_ns_, in_camera(calibration_, pose_), seen_, {}};
    sighting.reported.at_m[joint_of_landmark(8)].x += beside_m;
    sighting.abrupt.landmarks[8] = abrupt;
    EXPECT_TRUE(known_.add(calibration_.camera, sighting));
  };
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(add(0));
  for (int i = 0; i < 60; ++i) see_tip_beside(1e-3 * i, Abrupt::neither);
  see_tip_beside(0, Abrupt::detector);
  EXPECT_GT(index_moved_m(), 0.03) << "what the detector is blamed for at first";
  for (int i = 0; i < 3; ++i) see_tip_beside(0, Abrupt::neither);
  EXPECT_LT(index_moved_m(), 0.005);
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
