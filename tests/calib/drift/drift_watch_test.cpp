// SPDX-License-Identifier: Apache-2.0
#include "calib/drift/drift_watch.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/calib/drift/held_places.hpp"

namespace handcast::calib {
namespace {

using samples::HeldPlaces;
using samples::Rig;

Drift after(const Rig& rig, int places) {
  HeldPlaces hand(rig);
  DriftWatch watch(hand.calibration());
  for (int i = 0; i < places; ++i) hand.hold(watch);
  return watch.drift();
}

TEST(DriftWatch, ATrackerThatHasMovedIsReportedWithHowFar) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto drift = after({.seed = seed, .moved_mm = 5, .turned_deg = 1}, 40);
    EXPECT_TRUE(drift.moved) << seed << ": " << drift.across_mm << " mm, " << drift.turn_deg;
    EXPECT_NEAR(drift.across_mm, 5, 2.5) << seed;
    EXPECT_NEAR(drift.turn_deg, 1, 0.5) << seed;
    EXPECT_EQ(drift.places, 40);
  }
}

TEST(DriftWatch, OneThatHasNotMovedIsNeverReportedWhoeverTheHandIsOf) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    HeldPlaces hand({.seed = seed, .joints_mm = 5});
    DriftWatch watch(hand.calibration());
    for (int person = 0; person < 3; ++person) {
      for (int i = 0; i < 12; ++i) {
        hand.hold(watch);
        EXPECT_FALSE(watch.drift().moved) << seed << " " << watch.drift().across_mm << " mm";
      }
      hand.new_person();
    }
  }
}

// Then a moved tracker and a person's own joints look the same.
TEST(DriftWatch, AHandThatIsNeverTurnedLeavesDoubt) {
  const auto same = after({.moved_mm = 5, .always_the_same = true}, 20),
             turned = after({.moved_mm = 5}, 20);
  EXPECT_GT(same.across_sd_mm, 1.3 * turned.across_sd_mm);
}

TEST(DriftWatch, NothingIsLearntWhileTheHandMoves) {
  const auto drift = after({.moved_mm = 10, .sway_m_s = 0.1}, 20);
  EXPECT_EQ(drift.places, 0);
  EXPECT_EQ(drift.across_mm, 0);
  EXPECT_FALSE(drift.moved);
}

TEST(DriftWatch, ATrackerThatMovesMeanwhileIsReported) {
  HeldPlaces before({.seed = 3}),
      later({.seed = 4, .moved_mm = 8, .turned_deg = 1, .begin_s = 100});
  DriftWatch watch(before.calibration());
  for (int i = 0; i < 20; ++i) before.hold(watch);
  EXPECT_FALSE(watch.drift().moved);
  for (int person = 0; person < 4; ++person) {
    for (int i = 0; i < 12; ++i) later.hold(watch);
    later.new_person();
  }
  EXPECT_TRUE(watch.drift().moved) << watch.drift().across_mm;
}

TEST(DriftWatch, NumbersThatAreNotFiniteAreLeftOut) {
  HeldPlaces hand({.seed = 2});
  DriftWatch watch(hand.calibration());
  for (int i = 0; i < 8; ++i) hand.hold(watch);
  const auto before = watch.drift();
  TrackedHand tracked;
  SeenHand seen;
  for (auto& joint : tracked) joint.at_m.x = std::numeric_limits<double>::quiet_NaN();
  for (auto& point : seen) point = {{std::numeric_limits<double>::infinity(), 0}, 1};
  for (int i = 0; i < 200; ++i) {
    watch.add(0, seconds_to_ns(100 + 0.01 * i), tracked);
    watch.add(0, seconds_to_ns(100 + 0.01 * i), seen);
  }
  EXPECT_EQ(watch.drift().places, before.places);
  EXPECT_EQ(watch.drift().across_mm, before.across_mm);
}

}  // namespace
}  // namespace handcast::calib
