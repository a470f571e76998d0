// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/restart_policy.hpp"

#include <gtest/gtest.h>

namespace handcast::supervisor {
namespace {

using Action = Decision::Action;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr Exit kKilledExit{.signalled = true, .code = 9};

/// The waits in ms of `count` deaths that follow each other after `apart_ns` each, none of them
/// healthy.
std::vector<std::int64_t> waits_of(int count, std::int64_t apart_ns) {
  std::vector<std::int64_t> waits_ms;
  DeathRecord record;
  for (int i = 0; i < count; ++i) {
    auto decision =
        decide(record, {.died_ns = i * apart_ns, .ready_ns = std::nullopt, .exit = kKilledExit});
    waits_ms.push_back(decision.wait_ns / 1'000'000);
    record = decision.record;
  }
  return waits_ms;
}

TEST(RestartPolicy, TheFirstRestartComesAtOnceAndTheNextOnesWaitTwiceAsLongEach) {
  EXPECT_EQ(waits_of(6, kSecond_ns), (std::vector<std::int64_t>{0, 50, 100, 200, 400, 800}));
}

TEST(RestartPolicy, NoWaitIsLongerThanFiveSeconds) {
  const auto waits_ms = waits_of(40, 10 * kSecond_ns);
  EXPECT_EQ(waits_ms[7], 3200);
  EXPECT_EQ(waits_ms[8], 5000);
  EXPECT_EQ(waits_ms.back(), 5000);
}

TEST(RestartPolicy, ThirtySecondsOfHealthMakeTheNextRestartImmediateAgain) {
  const DeathRecord record{.streak = 5, .recent_ns = {}};
  const auto almost =
      decide(record, {.died_ns = 30 * kSecond_ns, .ready_ns = 1, .exit = kKilledExit});
  const auto healthy =
      decide(record, {.died_ns = 30 * kSecond_ns + 1, .ready_ns = 1, .exit = kKilledExit});
  EXPECT_EQ(almost.wait_ns, 800'000'000);
  EXPECT_EQ(healthy.wait_ns, 0);
  EXPECT_EQ(healthy.record.streak, 1);
}

TEST(RestartPolicy, TenDeathsWithinAMinuteAreAStormAndNineAreNot) {
  DeathRecord record;
  for (int i = 0; i < 9; ++i) {
    const auto decision =
        decide(record, {.died_ns = i * kSecond_ns, .ready_ns = std::nullopt, .exit = kKilledExit});
    EXPECT_EQ(decision.action, Action::restart) << i;
    record = decision.record;
  }
  const auto tenth =
      decide(record, {.died_ns = 59 * kSecond_ns, .ready_ns = std::nullopt, .exit = kKilledExit});
  EXPECT_EQ(tenth.action, Action::degrade);
  EXPECT_EQ(tenth.wait_ns, 5 * kSecond_ns);
  const auto later =
      decide(record, {.died_ns = 61 * kSecond_ns, .ready_ns = std::nullopt, .exit = kKilledExit});
  EXPECT_EQ(later.action, Action::restart) << "the first deaths are more than a minute ago";
}

TEST(RestartPolicy, DeathsRightAfterReadyStillAddUpToAStorm) {
  DeathRecord record;
  Decision decision;
  for (std::int64_t i = 1; i <= 10; ++i) {
    decision = decide(
        record, {.died_ns = i * kSecond_ns, .ready_ns = i * kSecond_ns - 1, .exit = kKilledExit});
    record = decision.record;
  }
  EXPECT_EQ(decision.action, Action::degrade);
}

TEST(RestartPolicy, JitterMakesAWaitUpToAQuarterLonger) {
  const Death death{.died_ns = kSecond_ns, .ready_ns = std::nullopt, .exit = kKilledExit};
  const DeathRecord third{.streak = 2, .recent_ns = {}};
  EXPECT_EQ(decide(third, death, 0).wait_ns, 100'000'000);
  EXPECT_EQ(decide(third, death, 0.5).wait_ns, 112'500'000);
  EXPECT_EQ(decide(third, death, 1).wait_ns, 125'000'000);
  EXPECT_EQ(decide({}, death, 1).wait_ns, 0) << "at once is at once";
}

TEST(RestartPolicy, AStormIsRetriedSlowlyAsLongAsItLasts) {
  DeathRecord record;
  for (std::int64_t i = 0; i < 40; ++i) {
    const auto decision = decide(
        record, {.died_ns = i * 5 * kSecond_ns, .ready_ns = std::nullopt, .exit = kKilledExit});
    if (i >= 9) {
      EXPECT_EQ(decision.action, Action::degrade) << i;
      EXPECT_EQ(decision.wait_ns, kLongestWait_ns) << i;
    }
    record = decision.record;
  }
}

TEST(RestartPolicy, AnUnknownEndIsADeath) {
  EXPECT_EQ(decide({}, {.died_ns = 1, .ready_ns = std::nullopt, .exit = {.unknown = true}}).action,
            Action::restart);
}

TEST(RestartPolicy, ExitHundredIsNeverRestarted) {
  const auto decision = decide(
      {}, {.died_ns = 1, .ready_ns = std::nullopt, .exit = {.signalled = false, .code = 100}});
  EXPECT_EQ(decision.action, Action::fail);
}

TEST(RestartPolicy, SignalHundredIsNotExitHundred) {
  const auto decision = decide(
      {}, {.died_ns = 1, .ready_ns = std::nullopt, .exit = {.signalled = true, .code = 100}});
  EXPECT_EQ(decision.action, Action::restart);
}

TEST(RestartPolicy, AServiceThatEndsWellByItselfIsLeftAlone) {
  const auto decision =
      decide({}, {.died_ns = 1, .ready_ns = 0, .exit = {.signalled = false, .code = 0}});
  EXPECT_EQ(decision.action, Action::retire);
}

}  // namespace
}  // namespace handcast::supervisor
