// SPDX-License-Identifier: Apache-2.0
#include "calib/drift/correction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/calib/drift/held_places.hpp"

namespace handcast::calib {
namespace {

using samples::HeldPlaces;
using ::testing::HasSubstr;

/// How far light lands beside its target, across the camera's axis, at some places: the largest.
double light_error_mm(const glm::dmat4& truth, const glm::dmat4& believed) {
  double most_mm = 0;
  for (const glm::dvec3 place : {glm::dvec3(0, 0, 0.73), {0.08, 0.05, 0.7}, {-0.08, -0.05, 0.8}}) {
    const auto tracker_m = glm::inverse(truth) * glm::dvec4(place, 1);
    const auto off = glm::dvec3(believed * tracker_m) - place;
    most_mm = std::max(most_mm, 1e3 * std::hypot(off.x, off.y));
  }
  return most_mm;
}

TEST(Correction, BringsTheLightBackToMostOfItsPlace) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    HeldPlaces hand({.seed = seed, .moved_mm = 6, .turned_deg = 1});
    DriftWatch watch(hand.calibration());
    for (int i = 0; i < 40; ++i) hand.hold(watch);
    const auto& before = hand.calibration().camera_from_tracker;
    const auto truth = hand.motion() * before;
    const auto after = corrected(hand.calibration(), watch.drift());
    ASSERT_TRUE(after) << after.error().what;
    EXPECT_LT(light_error_mm(truth, *after), 0.5 * light_error_mm(truth, before)) << seed;
  }
}

TEST(Correction, IsRefusedWithoutAMotionBeyondDoubt) {
  HeldPlaces hand({});
  DriftWatch watch(hand.calibration());
  for (int i = 0; i < 12; ++i) hand.hold(watch);
  const auto none = corrected(hand.calibration(), watch.drift());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::bad_data);
  EXPECT_THAT(none.error().what, HasSubstr("has not moved beyond doubt"));
}

TEST(Correction, IsBounded) {
  Drift drift{.places = 20, .moved = true, .across_mm = 21, .turn_deg = 0.1};
  const auto refused = corrected(reference_rig(), drift);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("measure its place anew"));
  drift.across_mm = 1;
  drift.turn_deg = 3.1;
  EXPECT_FALSE(corrected(reference_rig(), drift));
  drift.turn_deg = 1;
  drift.shift_m = {0.001, 0, 0.5};
  const auto bounded = corrected(reference_rig(), drift);
  ASSERT_TRUE(bounded);
  EXPECT_NEAR((*bounded)[3].z - reference_rig().camera_from_tracker[3].z, 0.003, 1e-9);
}

}  // namespace
}  // namespace handcast::calib
