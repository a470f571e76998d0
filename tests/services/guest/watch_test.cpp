// SPDX-License-Identifier: Apache-2.0
#include "services/guest/watch.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "ipc/base/clock.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/ring/writer.hpp"

namespace handcast::guest {
namespace {

using testing::HasSubstr;

class WatchTest : public testing::Test {
 protected:
  UniqueFd ring() const { return UniqueFd(::dup(segment_.fd())); }
  Watch watch(double silent_s) const {
    return {ipc::RingView::open(ring()).value(), {.silent_s = silent_s}, 0};
  }
  static std::int64_t at_s(double seconds) { return seconds_to_ns(seconds); }

  ipc::Segment segment_ =
      ipc::Segment::create(ipc::RingSpec::of<msg::HandPoses>("guest.pose", 4, true)).value();
  ipc::Writer<msg::HandPoses> program_ =
      ipc::Writer<msg::HandPoses>::attach(ipc::Segment::open(ring()).value()).value();
};

TEST_F(WatchTest, AProgramThatNeverSendsHasAMinute) {
  auto never = watch(10);
  EXPECT_FALSE(never.fault(at_s(59)));
  EXPECT_THAT(never.fault(at_s(60)).value_or(""),
              HasSubstr("nothing to guest.pose for 60 s since it was started"));
  EXPECT_FALSE(never.has_sent());
}

TEST_F(WatchTest, OneThatFallsSilentHasItsTime) {
  auto silent = watch(10);
  program_.publish({});
  EXPECT_TRUE(silent.has_sent());
  EXPECT_FALSE(silent.fault(at_s(100)));
  EXPECT_FALSE(silent.fault(at_s(109)));
  program_.publish({});
  EXPECT_FALSE(silent.fault(at_s(110)));
  EXPECT_FALSE(silent.fault(at_s(119)));
  EXPECT_THAT(silent.fault(at_s(120)).value_or(""), HasSubstr("nothing to guest.pose for 10 s"));
}

TEST_F(WatchTest, WhatAnEarlierProgramSentDoesNotCount) {
  program_.publish({});
  auto later = watch(10);
  EXPECT_FALSE(later.has_sent());
  EXPECT_TRUE(later.fault(at_s(60)));
}

TEST_F(WatchTest, OneThatMayBeSilentIsLeftAlone) {
  auto patient = watch(0);
  EXPECT_FALSE(patient.fault(at_s(1e6)));
  program_.publish({});
  EXPECT_FALSE(patient.fault(at_s(1e6)));
  EXPECT_FALSE(patient.fault(at_s(2e6)));
}

}  // namespace
}  // namespace handcast::guest
