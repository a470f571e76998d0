// SPDX-License-Identifier: Apache-2.0
#include "calib/drift/still_hands.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "ipc/base/clock.hpp"

namespace handcast::calib {
namespace {

TrackedHand tracked_at(const glm::dvec3& at, double turn_rad = 0) {
  TrackedHand hand;
  const glm::dmat3 axes(glm::rotate(glm::dmat4(1), turn_rad, {0, 1, 0}));
  for (std::size_t i = 0; i < kHandPoints; ++i)
    hand[i] = {at + axes * glm::dvec3(0.005 * static_cast<double>(i), 0, 0), axes};
  return hand;
}
SeenHand seen_at(const glm::dvec2& px) {
  SeenHand hand;
  for (auto& point : hand) point = {px, 1};
  return hand;
}

/// Shows a hand for a time; returns how often it was held.
int show(StillHands& hands, double& time_s, double for_s, const glm::dvec3& from,
         const glm::dvec3& velocity_m_s = {}, double turn_rad = 0) {
  int held = 0;
  for (const double begin_s = time_s; time_s < begin_s + for_s; time_s += 0.01) {
    const auto at = from + velocity_m_s * (time_s - begin_s);
    hands.add(seconds_to_ns(time_s), tracked_at(at, turn_rad));
    held += hands.add(seconds_to_ns(time_s - 0.005), seen_at({1000 * at.x, 0})).has_value();
  }
  return held;
}

TEST(StillHands, AHandIsHeldOnceAtEachPlaceAndAgainWhenItIsTurned) {
  StillHands hands;
  double time_s = 1;
  EXPECT_EQ(show(hands, time_s, 3, {0, 0, 0.7}), 1);
  EXPECT_EQ(show(hands, time_s, 3, {0.05, 0, 0.7}), 1);
  EXPECT_EQ(show(hands, time_s, 3, {0.05, 0, 0.7}, {}, 0.5), 1);
  EXPECT_EQ(show(hands, time_s, 0.3, {0.2, 0, 0.7}), 0) << "not long enough";
}

TEST(StillHands, AHandThatMovesIsNotHeld) {
  StillHands hands;
  double time_s = 1;
  EXPECT_EQ(show(hands, time_s, 3, {0, 0, 0.7}, {0.1, 0, 0}), 0);
}

TEST(StillHands, AHandThatMovesOnlyInTheImagesIsNotHeld) {
  StillHands hands;
  int held = 0;
  for (double time_s = 1; time_s < 4; time_s += 0.01) {
    hands.add(seconds_to_ns(time_s), tracked_at({0, 0, 0.7}));
    held += hands.add(seconds_to_ns(time_s - 0.005), seen_at({100 * time_s, 0})).has_value();
  }
  EXPECT_EQ(held, 0);
}

TEST(StillHands, AGapOfTheTrackerEndsTheMoment) {
  StillHands hands;
  double time_s = 1;
  int held = 0;
  for (int i = 0; i < 10; ++i) {
    held += show(hands, time_s, 0.4, {0.05 * i, 0, 0.7});
    time_s += 0.3;
  }
  EXPECT_EQ(held, 0);
  EXPECT_FALSE(hands.is_gone(seconds_to_ns(time_s)));
  EXPECT_TRUE(hands.is_gone(seconds_to_ns(time_s + 2)));
}

}  // namespace
}  // namespace handcast::calib
