// SPDX-License-Identifier: Apache-2.0
#include "services/projector/pacing.hpp"

#include <gtest/gtest.h>

namespace handcast::projector {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Pacer, ALateTickDoesNotDelayTheOnesAfterIt) {
  Pacer pacer(100);
  const std::int64_t start_ns = pacer.next_ns(5 * kMs);
  EXPECT_EQ(pacer.next_ns(start_ns + 1 * kMs) - start_ns, 10 * kMs);
  EXPECT_EQ(pacer.next_ns(start_ns + 19 * kMs) - start_ns, 20 * kMs);
  EXPECT_EQ(pacer.next_ns(start_ns + 21 * kMs) - start_ns, 30 * kMs);
  EXPECT_EQ(pacer.skipped(), 0);
}

TEST(Pacer, MissedTicksAreSkippedNotMadeUpFor) {
  Pacer pacer(100);
  const std::int64_t start_ns = pacer.next_ns(5 * kMs);
  EXPECT_EQ(pacer.next_ns(start_ns + 45 * kMs) - start_ns, 50 * kMs);
  EXPECT_EQ(pacer.next_ns(start_ns + 46 * kMs) - start_ns, 60 * kMs);
  EXPECT_EQ(pacer.skipped(), 4);
}

TEST(SleepWhile, ASlowFrameIsWaitedForInStepsAndAStopEndsTheWait) {
  int asked = 0;
  EXPECT_FALSE(sleep_while([&] { return ++asked < 3; }, now_ns() + 3'600'000 * kMs));
  EXPECT_EQ(asked, 3);
}

TEST(SleepWhile, ATimeThatIsThereIsAskedOnceAndNotWaitedFor) {
  int asked = 0;
  const auto running = [&] { return ++asked > 0; };
  EXPECT_TRUE(sleep_while(running, now_ns()));
  EXPECT_EQ(asked, 1);
  const std::int64_t then_ns = now_ns() + 1 * kMs;
  EXPECT_TRUE(sleep_while(running, then_ns));
  EXPECT_GE(now_ns(), then_ns);
}

config::Projector projector() {
  config::Projector settings;
  settings.rate_hz = 500;
  settings.latency_ms = 3;
  settings.software_ms = 2;
  return settings;
}

TEST(Horizon, StartsWithTheSoftwareTimeOfTheRig) {
  EXPECT_EQ(Horizon(projector()).target_ns(100 * kMs), (100 + 2 + 3 + 1) * kMs);
}

TEST(Horizon, FollowsTheMeasuredTimeAndNotOneSlowFrame) {
  Horizon horizon(projector());
  for (int i = 0; i < 40; ++i) horizon.learn(1 * kMs);
  horizon.learn(50 * kMs);
  EXPECT_EQ(horizon.software_ns(), 1 * kMs);
  for (int i = 0; i < 40; ++i) horizon.learn(4 * kMs);
  EXPECT_EQ(horizon.target_ns(0), (4 + 3 + 1) * kMs);
}

}  // namespace
}  // namespace handcast::projector
