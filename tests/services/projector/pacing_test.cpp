// SPDX-License-Identifier: Apache-2.0
#include "services/projector/pacing.hpp"

#include <gtest/gtest.h>

#include "services/projector/brightness.hpp"
#include "tests/milliseconds.hpp"

namespace handcast::projector {
namespace {

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
  const auto learn = [&](int frames, std::int64_t software_ms, std::int64_t light_ms) {
    for (int i = 0; i < frames; ++i)
      horizon.learn(kMs, {.handed_ns = (1 + software_ms) * kMs,
                          .display_ns = (1 + software_ms + light_ms) * kMs});
  };
  learn(40, 1, 4);
  learn(1, 50, 50);
  EXPECT_EQ(horizon.target_ns(0), (1 + 4) * kMs);
  learn(40, 4, 9);
  EXPECT_EQ(horizon.target_ns(0), (4 + 9) * kMs);
}

TEST(Horizon, BeginsAFrameEarlyEnoughForTheProjector) {
  Horizon horizon(projector());
  EXPECT_LT(horizon.begin_ns(100 * kMs), 98 * kMs);
  EXPECT_GT(horizon.begin_ns(100 * kMs), 96 * kMs);
}

TEST(Horizon, DoesNotBeginEverEarlierIfFramesWaitForTheProjector) {
  Horizon horizon(projector());
  for (std::int64_t refresh = 1; refresh <= 200; ++refresh) {
    const std::int64_t next_ns = refresh * 16 * kMs;
    const std::int64_t begin_ns = horizon.begin_ns(next_ns);
    horizon.learn(begin_ns, {.handed_ns = begin_ns + 2 * kMs, .display_ns = next_ns + 3 * kMs});
  }
  EXPECT_EQ(horizon.begin_ns(0), -2'800'000);  // 2 ms of software, a quarter of it, and 0.3 ms
  EXPECT_NEAR(horizon.target_ns(horizon.begin_ns(0)), 3 * kMs, 1000);
}

TEST(Brightness, RisesAtTheStartOfARig) {
  config::Projector settings;
  settings.fade_s = 1;
  constexpr std::int64_t kEpoch_ns = 50'000 * kMs, kFirst_ns = kEpoch_ns + 2'000 * kMs;
  Brightness brightness(settings, config::Light(), kEpoch_ns);
  EXPECT_EQ(brightness.at(kFirst_ns)[255], 0);
  const auto half = brightness.at(kFirst_ns + 500 * kMs);
  EXPECT_EQ(half, renderer::light_table(settings, 0.5));
  EXPECT_EQ(brightness.at(kFirst_ns + 1'000 * kMs), renderer::light_table(settings));
}

TEST(Brightness, IsFullAtOnceInAProcessThatReplacesAnotherOne) {
  Brightness brightness(config::Projector(), config::Light(), 50'000 * kMs);
  EXPECT_EQ(brightness.at(90'000 * kMs), renderer::light_table(config::Projector()));
}

/// A light that has been at full brightness for long.
Brightness full_brightness(double fade_s) {
  config::Projector settings;
  settings.fade_s = fade_s;
  Brightness brightness(settings, config::Light(), 1 * kMs);
  brightness.fade_at(90'000 * kMs);
  return brightness;
}

TEST(Brightness, ABlackoutIsAtOnceAndEndsAtOnce) {
  auto brightness = full_brightness(1);
  brightness.adjust({}, {.blackout = true}, 91'000 * kMs);
  EXPECT_EQ(brightness.at(91'000 * kMs), renderer::light_table({}, 0));
  EXPECT_FALSE(brightness.has_fallen()) << "the service does not end";
  brightness.adjust({}, {}, 92'000 * kMs);
  EXPECT_EQ(brightness.at(92'000 * kMs), renderer::light_table({}));
}

TEST(Brightness, TheMasterFadesFromWhereItIs) {
  auto brightness = full_brightness(1);
  brightness.adjust({}, {.master = 0.5, .master_s = 2}, 91'000 * kMs);
  EXPECT_NEAR(brightness.fade_at(92'000 * kMs), 0.75, 1e-9);
  brightness.adjust({}, {.blackout = true, .master = 0.5, .master_s = 2}, 92'000 * kMs);
  EXPECT_EQ(brightness.fade_at(92'000 * kMs), 0);
  brightness.adjust({}, {.master = 0.5, .master_s = 2}, 92'500 * kMs);
  EXPECT_NEAR(brightness.fade_at(92'500 * kMs), 0.625, 1e-9) << "it goes on meanwhile";
  brightness.adjust({}, {.master = 1, .master_s = 1}, 93'000 * kMs);
  EXPECT_NEAR(brightness.fade_at(93'500 * kMs), 0.75, 1e-9);
  EXPECT_NEAR(brightness.fade_at(99'000 * kMs), 1, 1e-9);
}

TEST(Brightness, TheLimitForEyesIsLive) {
  auto brightness = full_brightness(1);
  brightness.adjust({.brightness = 0.25}, {}, 91'000 * kMs);
  EXPECT_EQ(brightness.at(91'000 * kMs), renderer::light_table({.brightness = 0.25}));
}

TEST(Brightness, FallsEvenlyToBlackAndStaysBlack) {
  constexpr std::int64_t kFall_ns = 95'000 * kMs;
  auto brightness = full_brightness(1);
  brightness.fall(kFall_ns, 3'000 * kMs);
  for (int step = 0; step <= 10; ++step)
    EXPECT_NEAR(brightness.fade_at(kFall_ns + step * 100 * kMs), 1 - 0.1 * step, 1e-9);
  EXPECT_TRUE(brightness.has_fallen());
  brightness.fall(kFall_ns + 1'500 * kMs, 3'000 * kMs);
  EXPECT_EQ(brightness.at(kFall_ns + 1'500 * kMs), renderer::light_table({}, 0)) << "asked again";
}

TEST(Brightness, FallsFasterIfThereIsLessTime) {
  constexpr std::int64_t kFall_ns = 95'000 * kMs;
  auto brightness = full_brightness(10);
  brightness.fall(kFall_ns, 1'000 * kMs);
  EXPECT_NEAR(brightness.fade_at(kFall_ns + 250 * kMs), 0.75, 1e-9);
  EXPECT_FALSE(brightness.has_fallen());
  EXPECT_EQ(brightness.fade_at(kFall_ns + 1'000 * kMs), 0);
}

TEST(Brightness, FallsFromWhereItIsInTheMiddleOfItsRise) {
  config::Projector settings;
  settings.fade_s = 1;
  constexpr std::int64_t kFirst_ns = 2'000 * kMs, kFall_ns = kFirst_ns + 500 * kMs;
  Brightness brightness(settings, config::Light(), 1'000 * kMs);
  brightness.fade_at(kFirst_ns);
  EXPECT_NEAR(brightness.fade_at(kFall_ns), 0.5, 1e-9);
  brightness.fall(kFall_ns, 3'000 * kMs);
  EXPECT_NEAR(brightness.fade_at(kFall_ns), 0.5, 1e-9);
  EXPECT_NEAR(brightness.fade_at(kFall_ns + 500 * kMs), 0.25, 1e-9);
}

TEST(Brightness, IsBlackAtOnceWithoutAFade) {
  auto brightness = full_brightness(0);
  brightness.fall(95'000 * kMs, 3'000 * kMs);
  EXPECT_EQ(brightness.fade_at(95'000 * kMs), 0);
  EXPECT_TRUE(brightness.has_fallen());
}

}  // namespace
}  // namespace handcast::projector
