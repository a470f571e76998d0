// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/gate.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "tests/services/bridge/times.hpp"

namespace handcast::bridge {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kAhead = 500 * kSecond;  ///< their clock

class GateTest : public testing::Test {
 protected:
  GateTest() {
    // Known to 0.1 ms.
    clock_.add({now_ - 200'000, now_, now_ - 100'000 + kAhead, now_ - 100'000 + kAhead});
  }
  Claim claim(std::int64_t age_ns = 5 * kMs, Peer peer = 1) const {
    return {.peer = peer,
            .name = "rig@" + std::to_string(peer),
            .origin_ns = now_ - age_ns + kAhead,
            .published_ns = now_ - age_ns + kAhead + kMs};
  }
  Result<OurTimes> admit(const Claim& claim, const Result<void>& content = {}) {
    return gate_.admit(claim, content, &clock_, now_);
  }
  void expect_refused(const Claim& claim, Refusal why, const std::string& sentence,
                      const Result<void>& content = {}) {
    const auto before = gate_.refused(why);
    const auto times = admit(claim, content);
    ASSERT_FALSE(times);
    EXPECT_EQ(times.error().code, Errc::bad_data);
    EXPECT_THAT(times.error().what, HasSubstr(sentence));
    EXPECT_THAT(times.error().what, HasSubstr("pose.hands"));
    EXPECT_EQ(gate_.refused(why), before + 1);
  }

  std::int64_t now_ = 100 * kSecond;
  ClockMap clock_;
  Gate gate_{"pose.hands", "", 100 * kMs};
};

TEST_F(GateTest, AMessageGetsItsTimesByOurClock) {
  const auto times = admit(claim(5 * kMs));
  ASSERT_TRUE(times) << times.error().what;
  EXPECT_NEAR(static_cast<double>(times->origin_ns - (now_ - 5 * kMs)), 0, 1'000);
  EXPECT_NEAR(static_cast<double>(times->published_ns - (now_ - 4 * kMs)), 0, 1'000);
  EXPECT_EQ(gate_.admitted(), 1u);
}

TEST_F(GateTest, WhatCannotBeUsedIsRefusedWithASentence) {
  auto other = claim();
  other.version = 7;
  expect_refused(other, Refusal::version, "version 7 of the bridge");
  other = claim();
  other.is_its_own = false;
  expect_refused(other, Refusal::identity, "in the name of another");
  expect_refused(claim(), Refusal::content, "not a unit quaternion",
                 fail(Errc::bad_data, "not a unit quaternion"));
  expect_refused(claim(-5 * kMs), Refusal::future, "6 ms of the future");
  expect_refused(claim(150 * kMs), Refusal::old, "150 ms old");
  other = claim();
  other.origin_ns = other.published_ns + kSecond;  // predicted by a second
  expect_refused(other, Refusal::future, "of the future");
  EXPECT_EQ(gate_.admitted(), 0u);
  EXPECT_FALSE(gate_.holder());
}

TEST_F(GateTest, TimesThatNoClockShowsAreRefused) {
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  for (const auto ns : {kMost, -kMost, std::int64_t{-1}}) {
    auto hostile = claim();
    hostile.origin_ns = ns;
    EXPECT_FALSE(admit(hostile));
    hostile = claim();
    hostile.published_ns = ns;
    EXPECT_FALSE(admit(hostile));
  }
}

TEST_F(GateTest, WithoutAClockNothingIsUsed) {
  const auto times = gate_.admit(claim(), {}, nullptr, now_);
  ASSERT_FALSE(times);
  EXPECT_THAT(times.error().what, HasSubstr("clock is not known yet"));
}

TEST_F(GateTest, AClockThatIsNotKnownWellEnoughMakesMessagesTooOld) {
  ClockMap vague;
  vague.add({now_ - 300 * kMs, now_, now_ - 150 * kMs + kAhead, now_ - 150 * kMs + kAhead});
  const auto times = gate_.admit(claim(), {}, &vague, now_);
  ASSERT_FALSE(times);
  EXPECT_THAT(times.error().what, HasSubstr("clock is known to 150 ms"));
}

TEST_F(GateTest, AMessageThatWasOvertakenIsRefused) {
  ASSERT_TRUE(admit(claim(5 * kMs)));
  expect_refused(claim(6 * kMs), Refusal::overtaken, "after a newer one");
  expect_refused(claim(5 * kMs), Refusal::overtaken, "after a newer one");
}

TEST_F(GateTest, TheFirstSenderHoldsTheStreamUntilItIsGone) {
  ASSERT_TRUE(admit(claim(5 * kMs, 1)));
  expect_refused(claim(4 * kMs, 2), Refusal::second, "rig@2 also sends; rig@1 was first");
  EXPECT_FALSE(gate_.leave(2));
  EXPECT_TRUE(gate_.leave(1));
  EXPECT_TRUE(admit(claim(4 * kMs, 2)));
  EXPECT_EQ(gate_.holder(), Peer{2});
}

TEST_F(GateTest, ASenderOfUselessMessagesDoesNotHoldTheStream) {
  ASSERT_TRUE(admit(claim(5 * kMs, 1)));
  now_ += Gate::kHold_ns;
  EXPECT_FALSE(admit(claim(5 * kMs, 1), fail(Errc::bad_data, "NaN")));
  EXPECT_TRUE(admit(claim(5 * kMs, 2)));
}

TEST_F(GateTest, OnlyTheSenderOfTheSettingsIsUsed) {
  gate_ = Gate("pose.hands", "rig@2", 100 * kMs);
  expect_refused(claim(5 * kMs, 1), Refusal::unwanted, "bridge.from is rig@2");
  EXPECT_TRUE(admit(claim(5 * kMs, 2)));
}

TEST_F(GateTest, SaysOnceWhoSendsWhoIsSilentAndWhoIsBack) {
  EXPECT_FALSE(gate_.news(now_));
  admit(claim());
  EXPECT_EQ(gate_.news(now_), "pose.hands comes from rig@1");
  EXPECT_FALSE(gate_.news(now_));
  const auto silent = gate_.news(now_ + 2 * kSecond);
  ASSERT_TRUE(silent);
  EXPECT_THAT(*silent, HasSubstr("rig@1 has sent nothing usable for 2 s"));
  EXPECT_FALSE(gate_.news(now_ + 3 * kSecond));
  now_ += 4 * kSecond;
  ASSERT_TRUE(admit(claim()));
  EXPECT_EQ(gate_.news(now_), "pose.hands: rig@1 is back after 4.00 s");
  gate_.leave(1);
  EXPECT_THAT(*gate_.news(now_), HasSubstr("rig@1 is gone"));
}

TEST_F(GateTest, ASenderWhoseClockWentBackIsUsedAgainAfterTheHold) {
  ASSERT_TRUE(admit(claim(1 * kMs)));
  EXPECT_FALSE(admit(claim(50 * kMs)));
  now_ += Gate::kHold_ns;
  auto earlier = claim(5 * kMs);
  earlier.origin_ns -= Gate::kHold_ns;
  earlier.published_ns -= Gate::kHold_ns;
  ClockMap again;
  again.add({now_ - 200'000, now_, now_ - Gate::kHold_ns - 100'000 + kAhead,
             now_ - Gate::kHold_ns - 100'000 + kAhead});
  EXPECT_TRUE(gate_.admit(earlier, {}, &again, now_));
}

}  // namespace
}  // namespace handcast::bridge
