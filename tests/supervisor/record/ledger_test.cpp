// SPDX-License-Identifier: Apache-2.0
#include "supervisor/record/ledger.hpp"

#include <gtest/gtest.h>

#include "tests/milliseconds.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::int64_t kOneSecond_ns = 1'000'000'000;

msg::StageMarks frame_at(std::int64_t time_ns, std::int64_t span_ns = kMs) {
  msg::StageMarks marks;
  marks.header = {.frame_id = 1, .origin_ns = time_ns - 5 * kMs, .published_ns = time_ns};
  marks.count = 1;
  marks.marks[0] = {
      .stage = msg::Stage::draw, .detail = 0, .begin_ns = time_ns - span_ns, .end_ns = time_ns};
  return marks;
}

TEST(Histogram, PercentilesAreWithinAFewPercentOfTheSortedTruth) {
  Histogram times;
  for (int us = 1; us <= 1000; ++us) times.add(us * 1000);
  EXPECT_NEAR(times.percentile_ns(0.50), 500e3, 500e3 * 0.045);
  EXPECT_NEAR(times.percentile_ns(0.99), 990e3, 990e3 * 0.045);
  EXPECT_NEAR(times.percentile_ns(1.00), 1000e3, 1000e3 * 0.045);
}

TEST(Histogram, NothingAddedIsZeroAndNonsenseIsKeptInBounds) {
  Histogram times;
  EXPECT_EQ(times.percentile_ns(0.5), 0);
  times.add(-5);
  times.add(std::int64_t{1} << 62);
  EXPECT_EQ(times.count(), 2u);
  EXPECT_GT(times.percentile_ns(1), 1e11);
}

TEST(Ledger, AHeartBeatIsNotAFrame) {
  Ledger ledger;
  auto beat = frame_at(kOneSecond_ns);
  beat.count = 0;
  ledger.add("camera", beat);
  EXPECT_EQ(ledger.frames("camera").total(), 0u);
  EXPECT_TRUE(ledger.stages().empty());
}

TEST(Ledger, TheRungsOfAFramesHandsAreCounted) {
  Ledger ledger;
  auto marks = frame_at(kOneSecond_ns);
  marks.marks[0].stage = msg::Stage::correct;
  marks.marks[0].detail = msg::with_rung(msg::with_rung(0, msg::Side::left, msg::Rung::hold),
                                         msg::Side::right, msg::Rung::registered);
  ledger.add("projector", marks);
  marks.marks[0].detail = 0xffff;  // no rungs
  ledger.add("projector", marks);
  EXPECT_EQ(ledger.rungs(), (std::array<std::uint64_t, msg::kRungs>{1, 0, 0, 0, 0, 0, 1}));
}

TEST(Ledger, TheStagesOfASecondProjectorAreCountedForThemselves) {
  Ledger ledger;
  ledger.add("projector", frame_at(kOneSecond_ns, kMs));
  ledger.add("projector2", frame_at(kOneSecond_ns, 4 * kMs));
  ASSERT_EQ(ledger.stages().size(), 2u);
  EXPECT_NEAR(ledger.stages().at("draw").whole_run().percentile_ns(0.5), 1e6, 5e4);
  EXPECT_NEAR(ledger.stages().at("draw2").whole_run().percentile_ns(0.5), 4e6, 2e5);
}

TEST(Ledger, TheRefreshesWithoutANewFrameAreCounted) {
  Ledger ledger;
  EXPECT_TRUE(ledger.lights().empty());
  auto marks = frame_at(kOneSecond_ns);
  marks.marks[0].stage = msg::Stage::light;
  for (const std::uint32_t refreshes : {0u, 1u, 4u, 1u, 2u}) {
    marks.marks[0].detail = msg::detail_of({msg::LightSource::kernel, refreshes});
    ledger.add("projector", marks);
  }
  marks.marks[0].detail = 0x2ff;  // no source
  ledger.add("projector", marks);
  marks.marks[0] = {msg::Stage::draw, msg::detail_of({msg::LightSource::window, 7}), 0, 1};
  ledger.add("projector", marks);
  marks.marks[0] = {msg::Stage::light, msg::detail_of({msg::LightSource::window, 3}), 0, 1};
  ledger.add("projector2", marks);
  const auto light = ledger.lights().at("projector");
  EXPECT_EQ(light.source, msg::LightSource::kernel);
  EXPECT_EQ(light.missed, 4u);
  EXPECT_EQ(light.doubled, 2u);
  EXPECT_EQ(ledger.lights().at("projector2").missed, 2u);
}

TEST(Ledger, TheSlowestFramesAreKeptWithTheirCausesAfterTheFirstSecond) {
  Ledger ledger;
  const auto add = [&](std::int64_t time_ns, std::int64_t span_us, const msg::FrameDelay& delay) {
    auto marks = frame_at(time_ns, span_us * 1000);
    marks.marks[0].stage = msg::Stage::frame;
    marks.marks[0].detail = msg::detail_of(delay);
    ledger.add("projector", marks);
  };
  add(kOneSecond_ns, 50'000, {40'000, 1, 1});  // the start
  EXPECT_TRUE(ledger.slow_frames().empty());
  for (int i = 0; i < 500; ++i) add(3 * kOneSecond_ns + i * kMs, 1000, {});
  for (int i = 0; i < 40; ++i) add(4 * kOneSecond_ns + i * kMs, 2000 + i, {300, 2, 9});
  for (int i = 0; i < 30; ++i) add(5 * kOneSecond_ns + i * kMs, 2000, {200, 0, 0});
  for (int i = 0; i < 20; ++i) add(6 * kOneSecond_ns + i * kMs, 2000, {100, 1, 7});
  for (int i = 0; i < 10; ++i) add(7 * kOneSecond_ns + i * kMs, 2000, {199, 1, 0});
  const auto& slow = ledger.slow_frames().at("projector");
  const auto causes = slow.causes();
  EXPECT_EQ(slow.count(), 100u);
  EXPECT_EQ(slow.least_ns(), 2'000'000);
  EXPECT_EQ(causes.preempted, 40u);
  EXPECT_EQ(causes.interrupted, 30u);
  EXPECT_EQ(causes.faulted, 20u);
  EXPECT_EQ(causes.own, 10u);
}

TEST(FrameDelay, LargeCountsDoNotChangeTheOthers) {
  const msg::FrameDelay delay{70'000, 300, 256};
  EXPECT_EQ(msg::frame_delay_in(msg::detail_of(delay)), (msg::FrameDelay{65'535, 255, 255}));
  EXPECT_EQ(msg::frame_delay_in(msg::detail_of(msg::FrameDelay{12, 3, 4})),
            (msg::FrameDelay{12, 3, 4}));
}

TEST(Ledger, LostImagesAreCountedByReason) {
  Ledger ledger;
  auto marks = frame_at(kOneSecond_ns);
  marks.marks[0].stage = msg::Stage::capture;
  for (const msg::FrameLosses& lost :
       {msg::FrameLosses{1, 2, 3, 4}, {}, {.skipped = 10}, {.missing = 1000}}) {
    marks.marks[0].detail = msg::detail_of(lost);
    ledger.add("camera", marks);
  }
  EXPECT_EQ(ledger.lost_images().missing, 1 + 255u) << "a mark has room for 255";
  EXPECT_EQ(ledger.lost_images().incomplete, 2u);
  EXPECT_EQ(ledger.lost_images().underrun, 3u);
  EXPECT_EQ(ledger.lost_images().skipped, 14u);
  marks.marks[0].stage = msg::Stage::detect;
  ledger.add("landmarks", marks);
  EXPECT_EQ(ledger.lost_images().missing, 1 + 255u) << "only a camera loses images";
}

TEST(Ledger, FaultsOfTheTrackerAreCountedByKind) {
  Ledger ledger;
  auto marks = frame_at(kOneSecond_ns);
  marks.marks[0].stage = msg::Stage::sample;
  msg::TrackerFaults faults;
  faults.of(msg::TrackerFault::frozen) = 1;
  faults.of(msg::TrackerFault::impossible) = 1000;
  marks.marks[0].detail = msg::detail_of(faults);
  ledger.add("pose", marks);
  ledger.add("pose", marks);
  const auto counted = [&](msg::TrackerFault fault) {
    return ledger.tracker_faults()[static_cast<std::size_t>(fault)];
  };
  EXPECT_EQ(counted(msg::TrackerFault::frozen), 2u);
  EXPECT_EQ(counted(msg::TrackerFault::impossible), 2 * 31u) << "a mark has room for 31";
  EXPECT_EQ(counted(msg::TrackerFault::late), 0u);
  marks.marks[0].stage = msg::Stage::capture;
  ledger.add("camera", marks);
  EXPECT_EQ(counted(msg::TrackerFault::frozen), 2u) << "only a tracker has these faults";
}

TEST(Ledger, EachDetectorSaysWhetherItIsTheFallback) {
  Ledger ledger;
  auto marks = frame_at(kOneSecond_ns);
  marks.marks[0].stage = msg::Stage::detect;
  marks.marks[0].detail = msg::detail_of(msg::DetectorNote{.is_fallback = true});
  ledger.add("landmarks2", marks);
  EXPECT_TRUE(ledger.detector("landmarks2").is_fallback);
  EXPECT_FALSE(ledger.detector("landmarks").is_fallback);
  marks.marks[0].detail = 0;
  ledger.add("landmarks2", marks);
  EXPECT_FALSE(ledger.detector("landmarks2").is_fallback) << "started anew";
  marks.marks[0].stage = msg::Stage::sample;
  marks.marks[0].detail = 1;
  ledger.add("landmarks2", marks);
  EXPECT_FALSE(ledger.detector("landmarks2").is_fallback) << "only a detector says so";
}

TEST(Ledger, TheDriftOfTheTrackerIsThatOfItsNewestSample) {
  Ledger ledger;
  EXPECT_EQ(ledger.tracker_drift().places, 0u);
  auto marks = frame_at(kOneSecond_ns);
  marks.marks[0].stage = msg::Stage::watch;
  marks.marks[0].detail = msg::detail_of(msg::DriftNote{true, 9, 5, 1});
  ledger.add("pose", marks);
  EXPECT_TRUE(ledger.tracker_drift().moved);
  EXPECT_EQ(ledger.tracker_drift().places, 9u);
  marks.marks[0].stage = msg::Stage::detect;
  marks.marks[0].detail = 0;
  ledger.add("landmarks", marks);
  EXPECT_TRUE(ledger.tracker_drift().moved) << "only the tracker tells it";
  marks.marks[0].stage = msg::Stage::watch;
  ledger.add("pose", marks);
  EXPECT_FALSE(ledger.tracker_drift().moved) << "started anew";
}

TEST(Ledger, WhatIsKnownOfAnotherComputerIsThatOfItsNewestMessage) {
  Ledger ledger;
  EXPECT_FALSE(ledger.bridge());
  auto marks = frame_at(kOneSecond_ns);
  marks.marks[0].stage = msg::Stage::bridge;
  marks.marks[0].detail = msg::detail_of(msg::BridgeNote{84, 7});
  ledger.add("bridge", marks);
  ASSERT_TRUE(ledger.bridge());
  EXPECT_EQ(ledger.bridge()->clock_error_us, 84);
  EXPECT_EQ(ledger.bridge()->refused, 7u);
  const auto most = msg::bridge_note_in(msg::detail_of(msg::BridgeNote{1e9, 1'000'000}));
  EXPECT_EQ(most.clock_error_us, 131'070);
  EXPECT_EQ(most.refused, 65'535u);
}

TEST(LightNote, ManyRefreshesDoNotChangeTheSource) {
  const auto note = msg::light_note_in(msg::detail_of({msg::LightSource::window, 0xffffffff}));
  ASSERT_TRUE(note);
  EXPECT_EQ(note->source, msg::LightSource::window);
  EXPECT_EQ(note->refreshes, 0xffffffu);
}

TEST(Ledger, TheRecentRateIsThatOfTheLastTwoSeconds) {
  Ledger ledger;
  const auto start = 100 * kOneSecond_ns;
  for (int i = 0; i < 400; ++i)
    ledger.add("camera", frame_at(start + i * 10 * kMs));  // 100 Hz for 4 s
  EXPECT_NEAR(ledger.frames("camera").recent_hz(start + 4 * kOneSecond_ns), 100, 1);
  EXPECT_NEAR(ledger.frames("camera").recent_hz(start + 5 * kOneSecond_ns), 50, 1)
      << "nothing came for a second";
  EXPECT_EQ(ledger.frames("camera").recent_hz(start + 9 * kOneSecond_ns), 0);
  EXPECT_EQ(ledger.frames("nobody").recent_hz(start), 0);
}

TEST(Ledger, TheHeldRateLeavesOutTheFirstSecondAndCountsInterruptions) {
  Ledger ledger;
  const auto start = 100 * kOneSecond_ns;
  ledger.add("camera", frame_at(start));  // a slow first second: one frame
  for (int i = 0; i < 200; ++i)
    ledger.add("camera", frame_at(start + kOneSecond_ns + i * 10 * kMs));  // then 100 Hz for 2 s
  EXPECT_NEAR(ledger.frames("camera").held_hz(start + 3 * kOneSecond_ns), 100, 0.5);
  EXPECT_NEAR(ledger.frames("camera").held_hz(start + 5 * kOneSecond_ns), 50, 0.5)
      << "silent for the last two of four seconds";
}

TEST(Ledger, FramesWhoseMarksWereOverwrittenAreCounted) {
  Ledger ledger;
  const auto start = 100 * kOneSecond_ns;
  for (int i = 0; i <= 40; ++i)
    ledger.add("projector", frame_at(start + i * 100 * kMs),
               i > 0 ? 89 : 0);  // 900 Hz, one in 90 seen
  EXPECT_EQ(ledger.frames("projector").total(), 40u * 90 + 1);
  EXPECT_NEAR(ledger.frames("projector").recent_hz(start + 4 * kOneSecond_ns), 900, 10);
  EXPECT_NEAR(ledger.frames("projector").held_hz(start + 4 * kOneSecond_ns), 900, 35)
      << "to within one read";
}

TEST(Ledger, TheNewestAgeIsThatOfTheLastFramesOrigin) {
  Ledger ledger;
  ledger.add("pose", frame_at(kOneSecond_ns));
  EXPECT_DOUBLE_EQ(ledger.frames("pose").newest_age_ms(kOneSecond_ns + 3 * kMs).value(), 8.0);
  EXPECT_FALSE(ledger.frames("camera").newest_age_ms(kOneSecond_ns).has_value());
}

TEST(Ledger, StageTimesForgetWhatIsOlderThanTenSecondsButTheWholeRunDoesNot) {
  Ledger ledger;
  for (int second = 0; second < 30; ++second)
    ledger.add("projector", frame_at((100 + second) * kOneSecond_ns, second < 15 ? 8 * kMs : kMs));
  const auto& draw = ledger.stages().at("draw");
  EXPECT_EQ(draw.whole_run().count(), 30u);
  EXPECT_EQ(draw.recent(129 * kOneSecond_ns).count(), 10u);
  EXPECT_LT(draw.recent(129 * kOneSecond_ns).percentile_ns(0.99), 2e6);
  EXPECT_GT(draw.whole_run().percentile_ns(0.99), 7e6);
  EXPECT_EQ(draw.recent(150 * kOneSecond_ns).count(), 0u);
}

TEST(Ledger, ImpossibleMarksFromSharedMemoryAreLeftOut) {
  Ledger ledger;
  auto marks = frame_at(kOneSecond_ns);
  marks.count = 4'000'000'000u;
  marks.marks.fill({.stage = static_cast<msg::Stage>(77), .detail = 0, .begin_ns = 0, .end_ns = 0});
  ledger.add("camera", marks);
  EXPECT_TRUE(ledger.stages().empty());
}

}  // namespace
}  // namespace handcast::supervisor
