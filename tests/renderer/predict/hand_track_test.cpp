// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/hand_track.hpp"

#include <gtest/gtest.h>

#include "renderer/base/joint_math.hpp"
#include "tests/milliseconds.hpp"

/// @file
/// A tracker's hand that moves along x, reported every 9 ms until 180 ms.

namespace handcast::renderer {
namespace {

constexpr std::int64_t kSeen_ns = 175 * kMs, kTarget_ns = 195 * kMs;

/// `m_s`: its speed.
HandTrack track_at(float m_s) {
  HandTrack track({}, {});
  for (std::int64_t time_ns = 0; time_ns <= 180 * kMs; time_ns += 9 * kMs) {
    msg::HandPose pose;
    for (auto& joint : pose.joints) {
      joint.position_m = {1e-9f * m_s * static_cast<float>(time_ns), 0, 0.5f};
      joint.orientation_xyzw = {0, 0, 0, 1};
    }
    track.push(time_ns, time_ns, pose);
  }
  return track;
}

float x_mm(const HandTrack& track, std::int64_t time_ns) {
  return 1e3f * position(track.pose_at(time_ns)->joints[10]).x;
}

TEST(HandTrack, AHandThatRestsStaysWhereItWasSeenWhileItsTrackerDrifts) {
  auto track = track_at(0.04f);
  const float seen_mm = x_mm(track, kSeen_ns), predicted_mm = x_mm(track, kTarget_ns);
  EXPECT_NEAR(predicted_mm - seen_mm, 0.8f, 0.1f);
  track.rest({kSeen_ns, 1}, kTarget_ns);
  EXPECT_NEAR(x_mm(track, kTarget_ns), seen_mm, 1e-3f);
  EXPECT_EQ(track.held_ns(kTarget_ns), kSeen_ns);
  EXPECT_EQ(track.comparable_ns(), kSeen_ns);
  track.rest({kSeen_ns, 0.5f}, kTarget_ns);
  EXPECT_NEAR(x_mm(track, kTarget_ns), 0.5f * (seen_mm + predicted_mm), 0.02f);
}

TEST(HandTrack, WhatIsEarlierThanTheImageIsNotHeld) {
  auto track = track_at(0.04f);
  const float before_mm = x_mm(track, 100 * kMs);
  track.rest({kSeen_ns, 1}, kTarget_ns);
  EXPECT_EQ(x_mm(track, 100 * kMs), before_mm);
  EXPECT_EQ(x_mm(track, kSeen_ns), x_mm(track_at(0.04f), kSeen_ns));
}

/// What does not hold a hand, and how fast its tracker moves.
struct NotHeld {
  const char* name;
  HandTrack::Rest rest;
  float m_s;
};

TEST(HandTrack, AHandIsPredictedUnlessItRests) {
  const std::int64_t long_ago_ns = kTarget_ns - 101 * kMs;
  for (const auto& [name, rest, m_s] :
       {NotHeld{"it moves in the image", {kSeen_ns, 0}, 0.04f},
        NotHeld{"the tracker moves it by more than a drift", {kSeen_ns, 1}, 0.25f},
        NotHeld{"the image is old", {long_ago_ns, 1}, 0.01f},
        NotHeld{"the image is of later", {kTarget_ns + 1, 1}, 0.04f}}) {
    auto track = track_at(m_s);
    const float predicted_mm = x_mm(track, kTarget_ns);
    track.rest(rest, kTarget_ns);
    EXPECT_EQ(x_mm(track, kTarget_ns), predicted_mm) << name;
    EXPECT_EQ(track.comparable_ns(), track.begins_ns()) << name;
  }
}

}  // namespace
}  // namespace handcast::renderer
