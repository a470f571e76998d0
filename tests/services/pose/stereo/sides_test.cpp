// SPDX-License-Identifier: Apache-2.0
// When hands are compared with the models of both sides, and what follows.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/services/pose/stereo/two_views.hpp"

namespace handcast::pose::stereo {
namespace {

constexpr std::int64_t kSidesStep_ns = 8'000'000;
constexpr std::int64_t kRare_ns = 60'000'000;  ///< a comparison is due in each sample

TEST(Sides, NoSampleComparesTwoHandsAndBothTakeTurns) {
  for (const std::int64_t step_ns : {kSidesStep_ns, kRare_ns}) {
    TwoViews world(with_noise(1), "two_hands");
    std::uint64_t before = 0;
    for (int i = 0; i < 20; ++i) {
      const auto here = world.seen(0, i * step_ns), there = world.seen(1, i * step_ns);
      ASSERT_EQ(world.tracker().sample({&here, &there}).count, 2u) << i;
      const auto now = world.tracker().comparisons();
      EXPECT_LE(now - before, 1u) << i;
      if (i == 1) {
        EXPECT_EQ(now, 2u) << "the second hand in the second sample";
      }
      before = now;
    }
  }
}

TEST(Sides, LandmarksThatFitNoHandAreNotComparedInEachSample) {
  TwoViews world(with_noise(1), "wave");
  constexpr int kSamples = 100;
  int poses = 0;
  for (int i = 0; i < kSamples; ++i) {
    auto here = world.seen(0, i * kSidesStep_ns), there = world.seen(1, i * kSidesStep_ns);
    for (auto* seen : {&here, &there}) std::ranges::reverse(seen->hands[0].points);
    poses += static_cast<int>(world.tracker().sample({&here, &there}).count);
  }
  EXPECT_LT(poses, kSamples / 10);
  EXPECT_GT(world.tracker().comparisons(), 5u);
  EXPECT_LE(world.tracker().comparisons(), 20u) << "each 50 ms";
}

TEST(Sides, AHandThatStaysUnsureDoesNotKeepTheOtherFromItsTurn) {
  TwoViews world(with_noise(1), "wave");
  const msg::HandPose* pose = nullptr;
  msg::HandPoses poses;
  for (int i = 0; i < 10; ++i) {
    auto here = world.seen(0, i * kRare_ns), there = world.seen(1, i * kRare_ns);
    for (auto* seen : {&here, &there}) {
      auto& nonsense = seen->hands[seen->count++] = seen->hands[0];
      std::ranges::reverse(nonsense.points);
      for (auto& point : nonsense.points) point.x_px -= 250;
      seen->hands[0].side = msg::Side::right;
    }
    poses = world.tracker().sample({&here, &there});
    pose = poses.find(msg::Side::left);
  }
  ASSERT_TRUE(pose);
  EXPECT_LT(world.error_mm(*pose, poses.header.origin_ns), 15);
}

}  // namespace
}  // namespace handcast::pose::stereo
