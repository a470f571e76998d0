// SPDX-License-Identifier: Apache-2.0
#include "supervisor/record/recorder.hpp"

#include <gtest/gtest.h>

#include "ipc/ring/writer.hpp"
#include "tests/supervisor/record/marked_frames.hpp"

namespace handcast::supervisor {
namespace {

using msg::Stage;
using test::everything_in, test::frame, test::mark;

constexpr int kSlots = 32;

/// A service's ring of marks and a recorder that follows it.
struct Followed : testing::Test {
  ipc::Segment ring =
      ipc::Segment::create(ipc::RingSpec::of<msg::StageMarks>("marks.camera", kSlots, true))
          .value();
  ipc::Writer<msg::StageMarks> marks = ipc::Writer<msg::StageMarks>::attach(again()).value();
  Recorder recorder{60};

  ipc::Segment again() const { return ipc::Segment::open(UniqueFd(dup(ring.fd()))).value(); }
  void publish(int frames) {
    for (int i = 0; i < frames; ++i)
      marks.publish(frame(static_cast<std::uint64_t>(i), 0, {mark(Stage::capture, i, i + 1)}));
  }
};

TEST_F(Followed, WhatAServiceMarksIsInTheLedgerAndInTheHistory) {
  ASSERT_TRUE(recorder.follow("camera", ring.fd()));
  publish(10);
  recorder.poll();
  EXPECT_EQ(recorder.ledger().frames("camera").total(), 10u);
  const auto seen = everything_in(recorder.history());
  ASSERT_EQ(seen.frames.size(), 10u);
  EXPECT_EQ(seen.services[seen.frames[9].service], "camera");
  EXPECT_EQ(seen.frames[9].header.frame_id, 9u);
}

TEST_F(Followed, AServiceThatIsFollowedAlreadyIsNotCountedTwice) {
  ASSERT_TRUE(recorder.follow("camera", ring.fd()));
  ASSERT_TRUE(recorder.follow("camera", ring.fd()));
  publish(10);
  recorder.poll();
  EXPECT_EQ(recorder.ledger().frames("camera").total(), 10u);
}

TEST_F(Followed, WhatWasOverwrittenBeforeItWasReadIsCountedAsMissed) {
  ASSERT_TRUE(recorder.follow("camera", ring.fd()));
  publish(5);
  recorder.poll();
  publish(5 * kSlots);
  recorder.poll();
  std::uint64_t missed = 0;
  const auto seen = everything_in(recorder.history());
  for (const auto& each : seen.frames) missed += each.missed;
  EXPECT_LE(seen.frames.size(), 5u + kSlots);
  EXPECT_EQ(seen.frames.size() + missed, 5u + 5 * kSlots);
}

TEST_F(Followed, ARecorderThatComesLateBeginsWithWhatIsThereAndMissesNothing) {
  publish(5 * kSlots);
  ASSERT_TRUE(recorder.follow("camera", ring.fd()));
  recorder.poll();
  const auto seen = everything_in(recorder.history());
  ASSERT_FALSE(seen.frames.empty());
  EXPECT_EQ(seen.frames.front().missed, 0u);
  EXPECT_GE(seen.frames.size(), static_cast<std::size_t>(kSlots - 2));
}

}  // namespace
}  // namespace handcast::supervisor
