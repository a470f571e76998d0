// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/polls.hpp"

#include <gtest/gtest.h>

#include "ipc/base/clock.hpp"

namespace handcast::pose::openxr {
namespace {

constexpr std::int64_t kPeriod_ns = 10'000'000, kStart_ns = 1'000;

TEST(Polls, ARuntimeThatIsNewEachTimeIsAskedOncePerPeriod) {
  Polls polls(100, kStart_ns);
  for (std::uint64_t k = 0; k < 20; ++k) {
    const auto due_ns = polls.next_ns(0);
    EXPECT_EQ(due_ns, kStart_ns + static_cast<std::int64_t>(k + 1) * kPeriod_ns);
    EXPECT_EQ(polls.number(due_ns), k);
    polls.made(true);
  }
}

TEST(Polls, ARuntimeThatRepeatsItselfIsAskedOftenUntilItIsNew) {
  Polls polls(100, kStart_ns);
  const auto first_ns = polls.next_ns(0);
  polls.made(true);
  EXPECT_FALSE(polls.is_listening());
  polls.made(false);
  EXPECT_TRUE(polls.is_listening());
  polls.made(false);
  EXPECT_EQ(polls.next_ns(0), first_ns + kPeriod_ns + 2 * Polls::kListen_ns);
  polls.made(true);
  EXPECT_EQ(polls.next_ns(0), first_ns + 2 * kPeriod_ns + 2 * Polls::kListen_ns);
}

TEST(Polls, AfterALongSilenceItIsAskedFourTimesPerPeriod) {
  Polls polls(100, kStart_ns);
  for (int i = 0; i < 1000; ++i) polls.made(false);
  const auto before_ns = polls.next_ns(0);
  polls.made(false);
  EXPECT_EQ(polls.next_ns(0) - before_ns, kPeriod_ns / 4);
}

TEST(Polls, NumbersIncreaseFromNewAnswerToNewAnswer) {
  Polls polls(100, kStart_ns);
  std::uint64_t last = 0;
  for (int i = 0; i < 300; ++i) {
    const bool is_new = i % 7 == 0;
    const auto number = polls.number(polls.next_ns(0));
    if (is_new && i > 0) {
      EXPECT_GT(number, last);
    }
    if (is_new) last = number;
    polls.made(is_new);
  }
}

TEST(Polls, PollsThatWereMissedAreSkippedAndTheGridStays) {
  Polls polls(100, kStart_ns);
  EXPECT_EQ(polls.next_ns(kStart_ns + kPeriod_ns + kPeriod_ns / 4), kStart_ns + kPeriod_ns);
  const auto due_ns = polls.next_ns(kStart_ns + 7 * kPeriod_ns + kPeriod_ns / 3);
  EXPECT_EQ(due_ns, kStart_ns + 8 * kPeriod_ns);
  EXPECT_EQ(polls.number(due_ns), 7u);
}

}  // namespace
}  // namespace handcast::pose::openxr
