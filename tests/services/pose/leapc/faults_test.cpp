// SPDX-License-Identifier: Apache-2.0
// What the back end `leapc` does when the service, the device or the messages fail.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/services/pose/leapc/leapc_rig.hpp"

namespace handcast::pose {
namespace {

using testing::HasSubstr;

/// Whether a timeout of the source says this within 10 s.
bool says(PoseSource& source, const std::string& words) {
  const auto until = Deadline::in(10s);
  while (!until.passed())
    if (next_error(source, Errc::timeout).find(words) != std::string::npos) return true;
  return false;
}

class LeapcFaults : public testing::TestWithParam<std::pair<FakeFault, const char*>> {};

TEST_P(LeapcFaults, ABadMessageIsSaidAndLosesNothingElse) {
  auto& leap = fresh_leap();
  const auto source = open_leapc_source();
  next_sample(*source);
  leap.fault = GetParam().first;
  EXPECT_THAT(next_error(*source, Errc::bad_data), HasSubstr(GetParam().second));
  leap.fault = FakeFault::none;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(next_sample(*source).count, 1u);
  EXPECT_EQ(leap.connected, 1) << "the connection is kept";
}

INSTANTIATE_TEST_SUITE_P(Messages, LeapcFaults,
                         testing::Values(std::pair{FakeFault::null_event, "cannot be read"},
                                         std::pair{FakeFault::null_hands, "hands cannot be read"},
                                         std::pair{FakeFault::bad_hands, "hands cannot be read"},
                                         std::pair{FakeFault::many_hands, "4294967295 hands"},
                                         std::pair{FakeFault::not_a_number, "not finite"},
                                         std::pair{FakeFault::no_side, "neither left nor right"},
                                         std::pair{FakeFault::stamps_go_back, "not newer"},
                                         std::pair{FakeFault::short_message, "too short"}));

TEST(Leapc, LongerMessagesOfALaterVersionAreRead) {
  auto& leap = fresh_leap();
  leap.fault = FakeFault::long_message;
  const auto source = open_leapc_source();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(next_sample(*source).count, 1u);
}

TEST(Leapc, StampsOfAnotherClockAreReplacedByTheArrivals) {
  for (const auto fault : {FakeFault::stamps_of_epoch, FakeFault::stamps_ahead}) {
    fresh_leap().fault = fault;
    auto rig = leapc_rig();
    rig.pose.leapc.age_ms = 50;
    const auto source = open_leapc_source(rig);
    for (int i = 0; i < 20; ++i) {
      const auto poses = next_sample(*source);
      EXPECT_LE(poses.header.origin_ns, now_ns() - to_ns(49ms));
      EXPECT_GT(poses.header.origin_ns, now_ns() - to_ns(2s));
    }
  }
}

TEST(Leapc, ADeviceThatIsUnpluggedIsSaidAndComesBack) {
  auto& leap = fresh_leap();
  const auto source = open_leapc_source();
  const auto before = next_sample(*source);
  leap.has_device = false;
  EXPECT_TRUE(says(*source, "no device"));
  leap.has_device = true;
  const auto after = next_sample(*source);
  EXPECT_GT(after.header.frame_id, before.header.frame_id);
  EXPECT_GT(after.header.origin_ns, before.header.origin_ns);
  EXPECT_EQ(leap.connected, 1) << "the connection is kept";
}

TEST(Leapc, AServiceThatStopsIsSaidAndComesBack) {
  auto& leap = fresh_leap();
  const auto source = open_leapc_source();
  const auto before = next_sample(*source);
  leap.has_service = false;
  EXPECT_TRUE(says(*source, "systemctl start"));
  leap.mode = -1;
  leap.restarts_numbers = true;
  leap.has_service = true;
  const auto after = next_sample(*source);
  EXPECT_EQ(leap.mode, 0) << "the mode is set again";
  EXPECT_GT(after.header.frame_id, before.header.frame_id) << "numbers go on";
}

TEST(Leapc, AServiceThatIsAwayForLongIsConnectedToAnew) {
  auto& leap = fresh_leap();
  leap.has_service = false;
  const auto source = open_leapc_source();
  const auto until = Deadline::in(20s);
  while (leap.connected < 2 && !until.passed()) next_error(*source, Errc::timeout);
  EXPECT_GE(leap.connected, 2);
  leap.has_service = true;
  EXPECT_EQ(next_sample(*source).count, 1u);
  EXPECT_EQ(leap.connections, 1) << "the old connection was given back";
}

TEST(Leapc, ALibraryThatDoesNotReturnHoldsNobodyUp) {
  auto& leap = fresh_leap();
  const auto source = open_leapc_source();
  next_sample(*source);
  leap.fault = FakeFault::hangs;  // until the end of this test
  msg::HandPoses poses;
  int errors = 0;
  for (int i = 0; i < 20; ++i) {
    const auto deadline = Deadline::in(5ms);
    const auto sampled = source->sample(poses, deadline);
    if (sampled) continue;  // it was waiting
    // On a machine so slow that the hang is noticed here, the error comes at once.
    if (sampled.error().code == Errc::timeout) {
      EXPECT_GE(now_ns(), deadline.time_ns()) << "not before its deadline";
    }
    ++errors;
  }
  EXPECT_GE(errors, 15) << "while the library does not return at all";
  leap.fault = FakeFault::none;
}

TEST(Leapc, ALibraryThatHangsIsAnErrorThatEndsTheService) {
  auto& leap = fresh_leap();
  const auto source = open_leapc_source();
  next_sample(*source);
  leap.fault = FakeFault::hangs;
  EXPECT_THAT(next_error(*source, Errc::unavailable), HasSubstr("a call does not return"));
  leap.fault = FakeFault::none;
  EXPECT_EQ(next_sample(*source).count, 1u) << "it has returned";
}

TEST(Leapc, AServiceThatRefusesTheModeStillDeliversHands) {
  fresh_leap().fault = FakeFault::refused_mode;
  const auto source = open_leapc_source();
  EXPECT_EQ(next_sample(*source).count, 1u);
}

}  // namespace
}  // namespace handcast::pose
