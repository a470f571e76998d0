// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/clock_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "tests/services/bridge/times.hpp"

namespace handcast::bridge {
namespace {

using News = ClockMap::News;

/// Two computers and the messages between them.
struct TwoComputers {
  std::int64_t offset_ns = 1'000 * kSecond;
  double drift = 0;
  /// Delays of a question and an answer: constant, and a mean of what is added at random.
  /// @{
  std::int64_t there_ns = 100 * kUs, back_ns = 100 * kUs;
  std::int64_t jitter_ns = 0;
  /// @}
  double lost = 0;
  int times_stated = 1;  ///< how much more than stated the error may be

  std::int64_t theirs(std::int64_t our_ns) const {
    return our_ns + offset_ns + std::llround(drift * static_cast<double>(our_ns));
  }
  ClockExchange exchange(std::int64_t asked_ns) {
    const auto arrived_ns = asked_ns + there_ns + jitter();
    const auto answered_ns = arrived_ns + 20 * kUs;
    return {asked_ns, answered_ns + back_ns + jitter(), theirs(arrived_ns), theirs(answered_ns)};
  }
  /// Asks every 200 ms from `from_ns` to `to_ns`; at each answer the offset lies in its interval.
  void run(ClockMap& map, std::int64_t from_ns, std::int64_t to_ns) {
    for (auto ns = from_ns; ns < to_ns; ns += 200 * kMs) {
      if (std::uniform_real_distribution<>()(random) < lost) continue;
      const auto told = exchange(ns);
      if (told.heard_ns < heard_ns_of_last) continue;  // overtaken
      heard_ns_of_last = told.heard_ns;
      EXPECT_EQ(map.add(told), News::none);
      expect_within(map, told.heard_ns);
    }
  }
  void expect_within(const ClockMap& map, std::int64_t our_ns) const {
    const auto reading = map.at(our_ns);
    ASSERT_TRUE(reading);
    const auto wrong_ns = std::abs(reading->offset_ns - (theirs(our_ns) - our_ns));
    EXPECT_LE(wrong_ns, times_stated * reading->error_ns + 1) << "after " << our_ns / kMs << " ms";
  }

  std::int64_t jitter() {
    return jitter_ns > 0 ? std::llround(std::exponential_distribution<>(
                               1.0 / static_cast<double>(jitter_ns))(random))
                         : 0;
  }
  std::mt19937 random{5};
  std::int64_t heard_ns_of_last = 0;
};

TEST(ClockMap, KnowsNothingBeforeTheFirstAnswer) {
  EXPECT_FALSE(ClockMap().at(5));
  EXPECT_FALSE(ClockMap().to_ours(5));
}

TEST(ClockMap, OneAnswerTellsTheOffsetToHalfTheTimeOnTheWay) {
  TwoComputers two;
  ClockMap map;
  map.add(two.exchange(kSecond));
  const auto reading = map.at(kSecond);
  ASSERT_TRUE(reading);
  EXPECT_NEAR(static_cast<double>(reading->offset_ns - two.offset_ns), 0, 1.0 * kUs);
  EXPECT_NEAR(static_cast<double>(reading->error_ns), 100.0 * kUs, 2.0 * kUs);
}

TEST(ClockMap, LearnsTheDriftAndGoesOnWithItWhenNobodyAnswers) {
  TwoComputers two{.drift = 40e-6};
  ClockMap map;
  two.run(map, 0, 30 * kSecond);
  EXPECT_NEAR(map.at(30 * kSecond)->drift_ppm, 40, 6);
  two.expect_within(map, 40 * kSecond);
  EXPECT_GT(map.at(40 * kSecond)->error_ns, map.at(30 * kSecond)->error_ns);
}

TEST(ClockMap, TheFastestOfManyLateMessagesTellTheOffset) {
  TwoComputers two{.drift = -15e-6, .jitter_ns = 5 * kMs, .lost = 0.1};
  ClockMap map;
  two.run(map, 0, 30 * kSecond);
  EXPECT_LT(map.at(30 * kSecond)->error_ns, 1 * kMs);  // one exchange alone: some 5 ms
}

TEST(ClockMap, DelaysThatDifferByDirectionAreWithinTheStatedError) {
  TwoComputers two{.drift = 10e-6, .there_ns = 8 * kMs, .back_ns = 200 * kUs, .jitter_ns = kMs};
  ClockMap map;
  two.run(map, 0, 30 * kSecond);
  EXPECT_GT(map.at(30 * kSecond)->error_ns, 3 * kMs);
}

TEST(ClockMap, AClockThatJumpsIsMappedAnewByTheNextAnswer) {
  TwoComputers two{.drift = 5e-6};
  ClockMap map;
  two.run(map, 0, 10 * kSecond);
  two.offset_ns += 30 * kMs;
  EXPECT_EQ(map.add(two.exchange(10 * kSecond)), News::jumped);
  two.expect_within(map, 10 * kSecond);
  two.run(map, 10'200 * kMs, 15 * kSecond);
}

TEST(ClockMap, AClockWhoseRateChangesIsFollowedWithinTwiceTheStatedError) {
  TwoComputers two{.times_stated = 2};
  ClockMap map;
  two.run(map, 0, 10 * kSecond);
  two.drift = 300e-6;  // it is slewed
  two.offset_ns -= std::llround(two.drift * 10e9);
  two.run(map, 10 * kSecond, 20 * kSecond);
  EXPECT_NEAR(map.at(20 * kSecond)->drift_ppm, 300, 20);
}

TEST(ClockMap, AnswersThatCannotBeAreLeftOut) {
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  TwoComputers two;
  ClockMap map;
  map.add(two.exchange(kSecond));
  const auto before = map.at(kSecond);
  for (const auto& [arrived_ns, answered_ns] :
       {std::pair(two.theirs(kSecond), two.theirs(kSecond) - 1),
        {kMost, kMost},
        {-kMost, -kMost},
        {0L, kMost},
        {two.theirs(kSecond), two.theirs(kSecond) + kSecond}})
    EXPECT_EQ(map.add({kSecond, kSecond + kMs, arrived_ns, answered_ns}), News::impossible);
  EXPECT_EQ(map.at(kSecond)->offset_ns, before->offset_ns);
  EXPECT_FALSE(map.to_ours(kMost));
  EXPECT_FALSE(map.to_ours(-1));
}

TEST(ClockMap, MapsATimeAndBackToANanosecond) {
  TwoComputers two{.drift = 50e-6};
  ClockMap map;
  two.run(map, 0, 20 * kSecond);
  for (const auto our_ns : {19 * kSecond, 20 * kSecond, 20 * kSecond + 500 * kMs}) {
    const auto theirs = our_ns + map.at(our_ns)->offset_ns;
    EXPECT_NEAR(static_cast<double>(*map.to_ours(theirs) - our_ns), 0, 1);
  }
}

}  // namespace
}  // namespace handcast::bridge
