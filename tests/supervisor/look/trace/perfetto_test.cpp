// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/trace/perfetto.hpp"

#include <gmock/gmock.h>

#include "ipc/msg/frame_delay.hpp"
#include "ipc/msg/rung.hpp"
#include "tests/supervisor/look/trace/trace_decoder.hpp"
#include "tests/supervisor/record/marked_frames.hpp"

namespace handcast::supervisor {
namespace {

using msg::Stage;
using test::everything_in, test::frame, test::mark, test::kMs_ns, test::kStart_ns;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr ClockReadings kClocks{1'000, 2'000, 3'000};

test::SeenTrace trace_of(const History& history) {
  return test::decode_trace(perfetto_trace(everything_in(history), "desk", kClocks));
}

/// A frame of the projector, begun at `at_ms`.
msg::StageMarks projector_frame(std::uint64_t id, const test::Inputs& inputs, double at_ms) {
  return test::projector_frame(
      id, inputs,
      {mark(Stage::predict, at_ms, at_ms + 0.1), mark(Stage::draw, at_ms + 0.1, at_ms + 0.6),
       mark(Stage::frame, at_ms, at_ms + 0.7), mark(Stage::present, at_ms + 0.7, at_ms + 0.8)});
}

/// Two images, one detected, one tracker sample, four frames.
History small_rig() {
  History history(60);
  history.add("camera", frame(1, 0, {mark(Stage::capture, 0, 1)}), 0);
  history.add("camera", frame(2, 2, {mark(Stage::capture, 2, 3)}), 0);
  history.add("pose", frame(40, 0.5, {mark(Stage::sample, 0.5, 3.2)}), 0);
  history.add("landmarks", frame(1, 0, {mark(Stage::detect, 1.1, 4.5)}), 0);
  history.add("projector", projector_frame(11, {1, 0}, 1.2), 0);
  history.add("projector", projector_frame(12, {1, 0}, 2.2), 0);
  history.add("projector", projector_frame(13, {2, 2, 0.5}, 3.3), 0);
  history.add("projector", projector_frame(14, {2, 2, 0.5, 0}, 4.6), 0);
  return history;
}

std::vector<std::string> names_of(const std::vector<test::SeenSlice>& slices) {
  std::vector<std::string> names;
  for (const auto& slice : slices) names.push_back(slice.name);
  return names;
}

TEST(Perfetto, ATraceHasAProcessATrackPerServiceAndItsClock) {
  const auto trace = trace_of(small_rig());
  ASSERT_EQ(trace.fault, "");
  EXPECT_EQ(trace.process, "handcast desk");
  EXPECT_EQ(trace.pid, static_cast<std::uint64_t>(getpid()));
  std::vector<std::string> tracks;
  for (const auto& [id, name] : trace.tracks) tracks.push_back(name);
  EXPECT_THAT(tracks, ElementsAre("age of the image in the light", "camera", "pose", "landmarks",
                                  "projector"));
  constexpr int kRealtime = 1, kMonotonic = 3, kBoottime = 6;
  EXPECT_EQ(trace.primary_clock, kMonotonic);
  EXPECT_THAT(trace.clocks, ElementsAre(std::pair(kRealtime, 3'000), std::pair(kMonotonic, 1'000),
                                        std::pair(kBoottime, 2'000)));
}

TEST(Perfetto, EverySliceIsWhereItsMarkSays) {
  const auto trace = trace_of(small_rig());
  const auto captures = trace.named("capture");
  ASSERT_THAT(captures, SizeIs(2));
  EXPECT_EQ(captures[1].track, "camera");
  EXPECT_EQ(captures[1].begin_ns, kStart_ns + 2 * kMs_ns);
  EXPECT_EQ(captures[1].end_ns, kStart_ns + 3 * kMs_ns);
  EXPECT_EQ(captures[1].annotations.at("frame_id"), 2);
  EXPECT_DOUBLE_EQ(captures[1].annotations.at("age_ms"), 1);
  EXPECT_THAT(trace.slices, SizeIs(2 + 1 + 1 + 4 * 4));
}

TEST(Perfetto, TheCorrectionTellsTheRungOfEachHand) {
  History history(60);
  auto corrected = mark(msg::Stage::correct, 1, 2);
  corrected.detail = msg::with_rung(0, msg::Side::right, msg::Rung::similarity);
  history.add("projector", frame(1, 0, {corrected, mark(msg::Stage::frame, 0, 3)}), 0);
  const auto corrections = trace_of(history).named("correct");
  ASSERT_THAT(corrections, SizeIs(1));
  EXPECT_THAT(corrections[0].texts, ElementsAre(std::pair("right_hand", "similarity")));
}

TEST(Perfetto, AFrameTellsWhatDelayedIt) {
  History history(60);
  auto late = mark(msg::Stage::frame, 0, 3);
  late.detail = msg::detail_of(msg::FrameDelay{1500, 2, 0});
  history.add("projector", frame(1, 0, {late}), 0);
  const auto frames = trace_of(history).named("frame");
  ASSERT_THAT(frames, SizeIs(1));
  EXPECT_EQ(frames[0].annotations.at("off_cpu_us"), 1500);
  EXPECT_EQ(frames[0].annotations.at("preemptions"), 2);
  EXPECT_FALSE(frames[0].annotations.contains("page_faults"));
}

TEST(Perfetto, StagesOfAFrameLieInsideItAndItsPresentationBehindIt) {
  const auto trace = trace_of(small_rig());
  const auto draws = trace.named("draw");
  ASSERT_THAT(draws, SizeIs(4));
  for (const auto& draw : draws) {
    ASSERT_GE(draw.parent, 0);
    EXPECT_EQ(trace.slices[static_cast<std::size_t>(draw.parent)].name, "frame");
  }
  for (const auto& present : trace.named("present")) EXPECT_EQ(present.parent, -1);
}

TEST(Perfetto, AnImageFlowsIntoEveryFrameThatShowedIt) {
  const auto trace = trace_of(small_rig());
  const auto second = trace.named("capture")[1];
  ASSERT_THAT(second.flows, SizeIs(1)) << "it was not detected";
  const auto way = trace.along(second.flows[0]);
  EXPECT_THAT(names_of(way), ElementsAre("capture", "frame", "present", "frame", "present"));
  EXPECT_EQ(way[0].annotations.at("frame_id"), 2);
  for (const auto& slice : std::span(way).subspan(1))
    EXPECT_EQ(slice.annotations.at("image_id"), 2);
  EXPECT_EQ(way[1].annotations.at("frame_id"), 13);
}

TEST(Perfetto, ADetectionFlowsFromItsImageIntoTheFirstFrameThatKnewIt) {
  const auto trace = trace_of(small_rig());
  const auto detect = trace.named("detect")[0];
  ASSERT_THAT(detect.flows, SizeIs(1));
  EXPECT_THAT(trace.named("capture")[0].flows, Contains(detect.flows[0]));
  const auto way = trace.along(detect.flows[0]);
  EXPECT_THAT(names_of(way), ElementsAre("capture", "detect", "frame", "present"));
  EXPECT_EQ(way[2].begin_ns, kStart_ns + 4'600'000);
}

TEST(Perfetto, OnlyTheFirstOfTheFramesThatKnewADetectionIsOnItsWay) {
  auto history = small_rig();
  history.add("projector", projector_frame(15, {2, 2, 0.5, 0}, 5.6), 0);
  const auto trace = trace_of(history);
  const auto way = trace.along(trace.named("detect")[0].flows[0]);
  EXPECT_THAT(names_of(way), ElementsAre("capture", "detect", "frame", "present"));
  EXPECT_EQ(way[2].begin_ns, kStart_ns + 4'600'000);
}

TEST(Perfetto, AnImageOfTheSameTimeButAnotherNumberIsAnother) {
  History history(60);
  history.add("camera", frame(2, 0, {mark(Stage::capture, 0, 1)}), 0);
  history.add("projector", projector_frame(11, {1, 0}, 1.2), 0);
  EXPECT_THAT(trace_of(history).named("capture")[0].flows, IsEmpty());
}

TEST(Perfetto, AFrameInsideTheTimeOfAnotherIsNotDrawnAsItsPart) {
  History history(60);
  history.add("pose", frame(1, 0, {mark(Stage::sample, 0, 9)}), 0);
  history.add("pose", frame(2, 3, {mark(Stage::sample, 3, 8)}), 0);
  for (const auto& sample : trace_of(history).named("sample")) EXPECT_EQ(sample.parent, -1);
}

TEST(Perfetto, ASampleOfTheTrackerFlowsIntoTheFirstFrameThatKnewIt) {
  const auto trace = trace_of(small_rig());
  const auto sample = trace.named("sample")[0];
  ASSERT_THAT(sample.flows, SizeIs(1));
  const auto way = trace.along(sample.flows[0]);
  EXPECT_THAT(names_of(way), ElementsAre("sample", "frame", "present"));
  EXPECT_EQ(way[1].begin_ns, kStart_ns + 3'300'000);
}

TEST(Perfetto, AServiceWhoseFramesOverlapGetsAsManyLanesAsItNeeds) {
  History history(60);
  for (int i = 0; i < 20; ++i)
    history.add("pose", frame(i, i * 2.0, {mark(Stage::sample, i * 2.0, i * 2.0 + 5)}), 0);
  const auto trace = trace_of(history);
  ASSERT_EQ(trace.fault, "");
  std::map<std::uint64_t, int> slices_of_lane;
  for (const auto& slice : trace.named("sample")) {
    EXPECT_EQ(slice.track, "pose");
    EXPECT_EQ(slice.end_ns - slice.begin_ns, 5 * kMs_ns);
    EXPECT_EQ(slice.parent, -1);
    ++slices_of_lane[slice.track_id];
  }
  EXPECT_THAT(slices_of_lane, SizeIs(3));
}

TEST(Perfetto, TheAgeOfTheImageInTheLightIsACounter) {
  const auto trace = trace_of(small_rig());
  ASSERT_THAT(trace.ages_ms, SizeIs(4));
  EXPECT_NEAR(trace.ages_ms[0], 2.0, 1e-5);  // shown from 1.2 to 2.0
  EXPECT_NEAR(trace.ages_ms[3], 3.4, 1e-5);
}

TEST(Perfetto, FramesWithoutAnOriginAndOfNoImageAreShownWithoutFlowOrAge) {
  History history(60);
  history.add("projector", projector_frame(1, {}, 1), 0);
  history.add("projector", projector_frame(2, {99, -5}, 3), 2);
  const auto trace = trace_of(history);
  ASSERT_EQ(trace.fault, "");
  EXPECT_THAT(trace.ages_ms, SizeIs(1));
  for (const auto& slice : trace.slices) EXPECT_THAT(slice.flows, IsEmpty());
  EXPECT_EQ(trace.named("frame")[1].annotations.at("marks_lost"), 2);
}

TEST(Perfetto, ZeroLengthsAndWildMarksStillMakeATrace) {
  History history(60);
  history.add(
      "projector",
      frame(1, 0, {mark(Stage::draw, 1, 1), mark(Stage::warp, 1, 1), mark(Stage::frame, 1, 1)}), 0);
  auto wild =
      frame(2, 0, {mark(Stage::draw, 1, 2), mark(Stage::warp, 1.5, 9), mark(Stage::frame, 0.5, 3)});
  wild.marks[0].begin_ns = 0;
  wild.header.origin_ns = std::numeric_limits<std::int64_t>::min();
  history.add("projector", wild, 0);
  const auto trace = trace_of(history);
  EXPECT_EQ(trace.fault, "");
  EXPECT_THAT(trace.slices, SizeIs(6));
}

TEST(Perfetto, NothingToTellIsATraceToo) {
  const auto trace = trace_of(History(60));
  EXPECT_EQ(trace.fault, "");
  EXPECT_THAT(trace.slices, IsEmpty());
}

}  // namespace
}  // namespace handcast::supervisor
