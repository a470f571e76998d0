// SPDX-License-Identifier: Apache-2.0
// What a program outside the rig may send, and what it cannot do to the service that reads it.
#include "services/runtime/guest_stream.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <thread>

#include "tests/services/guest_ring.hpp"

namespace handcast::service {
namespace {

using namespace std::chrono_literals;
using msg::HandPoses;
using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

HandPoses hand_at(std::int64_t origin_ns) {
  HandPoses poses;
  poses.header.origin_ns = origin_ns;
  poses.count = 1;
  poses.hands[0].confidence = 1;
  return poses;
}

class GuestStreamTest : public testing::Test {
 protected:
  /// The sentence of why a sample is left out; "" if it is not.
  std::string why_left_out(const HandPoses& poses) {
    ring_.send(poses);
    const auto taken = guests_.latest(Deadline::in(1s));
    if (taken) return "";
    EXPECT_EQ(taken.error().code, Errc::bad_data);
    return taken.error().what;
  }
  /// A sample of now that is spoilt.
  template <class Spoil>
  std::string why_left_out(const Spoil& spoil) {
    auto poses = hand_at(now_ns());
    spoil(poses);
    return why_left_out(poses);
  }

  /// Whether a program that sends now and then is heard.
  bool is_heard_in_time() {
    const auto end_ns = now_ns() + to_ns(10s);
    do ring_.send(hand_at(now_ns()));
    while (!guests_.latest(Deadline::in(700ms)) && now_ns() < end_ns);
    return now_ns() < end_ns;
  }

  test::GuestRing<HandPoses> ring_{"guest.pose"};
  GuestStream<HandPoses> guests_ =
      GuestStream<HandPoses>::open(ring_.open(), "guest.pose", ipc::Wait::futex).value();
};

TEST_F(GuestStreamTest, GivesTheNewestThatWasSent) {
  const auto first_ns = now_ns() - 2;
  ring_.send(hand_at(first_ns));
  ring_.send(hand_at(first_ns + 1));
  const auto taken = guests_.latest(Deadline::in(1s));
  ASSERT_TRUE(taken) << taken.error().what;
  EXPECT_EQ((*taken)->header.origin_ns, first_ns + 1);
  const auto silence = guests_.latest(Deadline::in(5ms));
  ASSERT_FALSE(silence);
  EXPECT_EQ(silence.error().code, Errc::timeout);
}

TEST_F(GuestStreamTest, WhatAnEarlierProgramLeftIsNotTaken) {
  ring_.send(hand_at(now_ns()));
  auto later = GuestStream<HandPoses>::open(ring_.open(), "guest.pose", ipc::Wait::futex).value();
  const auto silence = later.latest(Deadline::in(5ms));
  ASSERT_FALSE(silence);
  EXPECT_THAT(silence.error().what, HasSubstr("no program has sent anything"));
}

TEST_F(GuestStreamTest, TimesThatCannotBeAreLeftOutAndNamed) {
  EXPECT_EQ(why_left_out(hand_at(now_ns())), "");
  EXPECT_EQ(why_left_out(hand_at(now_ns() + to_ns(20ms))), "") << "a tracker may predict";
  EXPECT_THAT(why_left_out(hand_at(now_ns())), HasSubstr("not later than"));
  EXPECT_THAT(why_left_out(hand_at(now_ns() + to_ns(1s))), HasSubstr("in the future"));
  EXPECT_THAT(why_left_out(hand_at(now_ns() - to_ns(2s))), HasSubstr("s ago"));
  EXPECT_THAT(why_left_out(hand_at(0)), HasSubstr("CLOCK_MONOTONIC"));
  for (const auto limit :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()})
    EXPECT_NE(why_left_out(hand_at(limit)), "");
}

TEST_F(GuestStreamTest, HandsThatCannotBeAreLeftOutAndNamed) {
  const auto joint = [](HandPoses& poses) -> msg::Joint& { return poses.hands[0].joints[7]; };
  EXPECT_THAT(why_left_out([](auto& poses) { poses.count = 3; }), HasSubstr("3 hands"));
  EXPECT_THAT(why_left_out([](auto& poses) { poses.count = 2; }), HasSubstr("same side"));
  EXPECT_THAT(why_left_out([](auto& poses) { poses.hands[0].side = msg::Side{7}; }),
              HasSubstr("neither"));
  EXPECT_THAT(why_left_out([](auto& poses) { poses.hands[0].confidence = kNaN; }),
              HasSubstr("confidence"));
  EXPECT_THAT(why_left_out([&](auto& poses) { joint(poses).position_m[1] = kNaN; }),
              HasSubstr("position of joint 7"));
  EXPECT_THAT(why_left_out([&](auto& poses) { joint(poses).position_m[1] = 300; }),
              HasSubstr("metres"));
  EXPECT_THAT(why_left_out([&](auto& poses) { joint(poses).radius_m = -1; }), HasSubstr("radius"));
  EXPECT_THAT(why_left_out([&](auto& poses) { joint(poses).orientation_xyzw[3] = 0; }),
              HasSubstr("unit quaternion"));
  EXPECT_EQ(why_left_out([](auto&) {}), "") << "the next good one is taken";
}

TEST_F(GuestStreamTest, AFloodIsThinned) {
  const auto begin_ns = now_ns();
  int taken = 0;
  while (now_ns() < begin_ns + to_ns(50ms)) {
    ring_.send(hand_at(now_ns()));
    taken += guests_.latest(Deadline::now()) ? 1 : 0;
  }
  EXPECT_GT(taken, 0);
  EXPECT_LE(taken, ns_to_ms(now_ns() - begin_ns) * 2 + 1);
}

TEST_F(GuestStreamTest, AProgramThatStopsInTheMiddleIsSilent) {
  const auto begun = ring_.stop_in_the_middle();
  begun->count = 1;
  const auto silence = guests_.latest(Deadline::in(5ms));
  ASSERT_FALSE(silence);
  EXPECT_EQ(silence.error().code, Errc::timeout);
}

TEST_F(GuestStreamTest, AfterNoiseTheNextProgramIsHeard) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ring_.write_noise(seed);
    EXPECT_FALSE(guests_.latest(Deadline::in(2ms))) << "noise is no hand";
  }
  ring_.begin();
  EXPECT_TRUE(is_heard_in_time());
}

/// A reader whose row was overwritten is not woken: it looks every 100 ms.
TEST_F(GuestStreamTest, AfterNoiseItIsWokenAgain) {
  ring_.write_noise(1);
  ring_.wipe();
  ring_.begin();
  EXPECT_TRUE(is_heard_in_time());
  std::int64_t shortest_ns = to_ns(1h);
  for (int i = 0; i < 10; ++i) {
    const auto begin_ns = now_ns();
    const std::jthread program([&] {
      sleep_until_ns(begin_ns + to_ns(5ms));
      ring_.send(hand_at(now_ns()));
    });
    EXPECT_TRUE(guests_.latest(Deadline::in(50ms)));
    shortest_ns = std::min(shortest_ns, now_ns() - begin_ns);
  }
  EXPECT_LT(shortest_ns, to_ns(40ms));
}

TEST_F(GuestStreamTest, WithoutARigThereAreNoPrograms) {
  const auto none = GuestStream<HandPoses>::open({}, "guest.pose", ipc::Wait::futex);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::unavailable);
}

TEST(GuestLandmarks, PointsThatCannotBeAreNamed) {
  const auto why = [](const auto& spoil) {
    msg::Landmarks landmarks;
    landmarks.count = 1;
    landmarks.hands[0].presence = 1;
    spoil(landmarks.hands[0]);
    const auto fits = msg::check_guest(landmarks);
    return fits ? std::string() : fits.error().what;
  };
  EXPECT_EQ(why([](auto&) {}), "");
  EXPECT_THAT(why([](auto& hand) { hand.points[3].x_px = kNaN; }), HasSubstr("landmark 3"));
  EXPECT_THAT(why([](auto& hand) { hand.points[3].y_px = 1e9f; }), HasSubstr("landmark 3"));
  EXPECT_THAT(why([](auto& hand) { hand.points[3].sigma_px = -1; }), HasSubstr("sigma"));
  EXPECT_THAT(why([](auto& hand) { hand.points[3].confidence = 2; }), HasSubstr("confidence"));
  EXPECT_THAT(why([](auto& hand) { hand.presence = kNaN; }), HasSubstr("presence"));
}

}  // namespace
}  // namespace handcast::service
