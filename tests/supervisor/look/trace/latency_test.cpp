// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "supervisor/look/trace/latency_table.hpp"
#include "tests/supervisor/record/marked_frames.hpp"

namespace handcast::supervisor {
namespace {

using msg::Stage;
using test::everything_in, test::frame, test::mark, test::projector_frame, test::kMs_ns;
using testing::HasSubstr;

const Spans& way(const LatencyTable& table, const std::string& from, const std::string& to) {
  static const Spans kNone({});
  for (const auto& each : table.ways)
    if (each.from == from && each.to == to) return each.spans;
  return kNone;
}

LatencyTable table_of(const History& history, const std::map<std::string, double>& wanted_hz = {}) {
  return measure_latency(everything_in(history), wanted_hz);
}

/// Frames of a camera at 100 Hz, delivered 3 ms after their exposure, those in `left_out` never.
History camera(int frames, std::vector<int> left_out, int late = -1) {
  History history(600);
  for (int i = 0; i < frames; ++i) {
    if (std::ranges::find(left_out, i) != left_out.end()) continue;
    const double ms = i * 10.0, delivered_ms = ms + (i == late ? 9 : 3);
    history.add("camera",
                frame(static_cast<std::uint64_t>(i), ms, {mark(Stage::capture, ms, delivered_ms)}),
                0);
  }
  return history;
}

TEST(Spans, PercentilesAreThoseOfTheNearestRank) {
  std::vector<std::int64_t> us;
  for (int i = 1000; i >= 1; --i) us.push_back(i);
  const Spans spans(us);
  EXPECT_EQ(spans.percentile_ns(0.5), 500);
  EXPECT_EQ(spans.percentile_ns(0.99), 990);
  EXPECT_EQ(spans.percentile_ns(0.999), 999);
  EXPECT_EQ(spans.percentile_ns(1), 1000);
  EXPECT_EQ(Spans({5, 7}).percentile_ns(0.5), 5);
  EXPECT_EQ(Spans({5, 7}).percentile_ns(0.999), 7);
  EXPECT_EQ(Spans({}).percentile_ns(0.5), 0);
}

TEST(Latency, EveryStageOfEveryServiceHasItsExactTimes) {
  History history(60);
  for (int i = 1; i <= 200; ++i)
    history.add("projector",
                frame(1, 0, {mark(Stage::draw, i, i + 0.001 * i), mark(Stage::frame, i, i + 0.5)}),
                0);
  const auto table = table_of(history);
  ASSERT_EQ(table.stages.size(), 2u);
  EXPECT_EQ(table.stages[0].service, "projector");
  EXPECT_EQ(table.stages[0].stage, "draw");
  EXPECT_EQ(table.stages[0].spans.count(), 200u);
  EXPECT_NEAR(static_cast<double>(table.stages[0].spans.percentile_ns(0.99)), 198e3, 2);
  EXPECT_NEAR(static_cast<double>(table.stages[1].spans.percentile_ns(1)), 500e3, 2);
}

TEST(Latency, TheWayFromExposureToLightIsToldLegByLeg) {
  History history(60);
  history.add("camera", frame(1, 10, {mark(Stage::capture, 10, 12)}), 0);
  history.add("pose", frame(9, 8, {mark(Stage::sample, 8, 12.5)}), 0);
  history.add("landmarks", frame(1, 10, {mark(Stage::detect, 12.1, 13.5)}), 0);
  history.add(
      "projector",
      projector_frame(1, {1, 10, 8}, {mark(Stage::frame, 13, 14), mark(Stage::present, 14, 14.5)}),
      0);
  history.add("projector",
              projector_frame(2, {1, 10, 8, 10},
                              {mark(Stage::frame, 15, 16), mark(Stage::present, 16, 16.5)}),
              0);
  const auto table = table_of(history);
  EXPECT_EQ(way(table, "exposure", "image delivered").percentile_ns(1), 2 * kMs_ns);
  EXPECT_EQ(way(table, "exposure", "landmarks found").percentile_ns(1), 3'500'000);
  EXPECT_EQ(way(table, "exposure", "frame begun").percentile_ns(0.5), 3 * kMs_ns);
  EXPECT_EQ(way(table, "exposure", "light").count(), 2u);
  EXPECT_EQ(way(table, "exposure", "light").percentile_ns(0.5), 4'500'000);
  EXPECT_EQ(way(table, "exposure", "light").percentile_ns(1), 6'500'000);
  EXPECT_EQ(way(table, "image delivered", "first light").count(), 1u);
  EXPECT_EQ(way(table, "image delivered", "first light").percentile_ns(1), 2'500'000);
  EXPECT_EQ(way(table, "landmarks' exposure", "light").count(), 1u) << "the first frame knew none";
  EXPECT_EQ(way(table, "pose sample", "light").percentile_ns(0.5), 6'500'000);
}

TEST(Misses, AServiceThatHoldsItsRateMissesNothing) {
  const auto misses = table_of(camera(100, {}, 50), {{"camera", 100}}).misses.at(0);
  EXPECT_EQ(misses.frames, 100u);
  EXPECT_EQ(misses.missed, 0u);
  EXPECT_EQ(misses.late, 1u) << "one came 16 ms after the one before";
  EXPECT_EQ(misses.skipped_ids, 0u);
  EXPECT_NEAR(misses.held_hz, 100, 0.1);
}

TEST(Misses, GapsAreCountedInPeriodsOfTheAskedRateAndInNumbers) {
  const auto misses = table_of(camera(100, {20, 50, 51, 52}), {{"camera", 100}}).misses.at(0);
  EXPECT_EQ(misses.missed, 4u);
  EXPECT_EQ(misses.late, 2u);
  EXPECT_EQ(misses.skipped_ids, 4u);
  EXPECT_EQ(misses.longest_gap_ns, 40 * kMs_ns);
}

TEST(Misses, FramesWhoseMarksWereLostAreNotHeldAgainstTheService) {
  History history(600);
  for (int i = 0; i < 100; i += 5) {
    const double ms = i * 10.0;
    history.add("camera",
                frame(static_cast<std::uint64_t>(i), ms, {mark(Stage::capture, ms, ms + 3)}),
                i > 0 ? 4 : 0);
  }
  const auto misses = table_of(history, {{"camera", 100}}).misses.at(0);
  EXPECT_EQ(misses.missed, 0u);
  EXPECT_EQ(misses.late, 0u);
  EXPECT_EQ(misses.skipped_ids, 0u);
  EXPECT_EQ(misses.lost_marks, 19u * 4);
  EXPECT_NEAR(misses.held_hz, 100, 0.1);
}

TEST(Misses, AServiceWithoutARateMissesNoneAndRepeatedImagesAreNoGaps) {
  History history(60);
  for (int i = 0; i < 10; ++i)
    history.add("projector",
                frame(7 + static_cast<std::uint64_t>(i % 3) * 50, 0,
                      {mark(Stage::frame, i * 30, i * 30 + 1)}),
                0);
  const auto misses = table_of(history).misses.at(0);
  EXPECT_EQ(misses.missed, 0u);
  EXPECT_EQ(misses.skipped_ids, 0u);
}

TEST(Latency, ThePageNamesWhatItShowsAndTheJsonHasTheSameFigures) {
  const auto table = table_of(camera(100, {20}), {{"camera", 100}});
  const auto page = print_latency(table);
  EXPECT_THAT(page, HasSubstr("image delivered"));
  EXPECT_THAT(page, HasSubstr("3.00 ms"));
  const auto json = to_json(table);
  EXPECT_EQ(json["stages"][0]["stage"], "capture");
  EXPECT_EQ(json["stages"][0]["p50_us"], 3000);
  EXPECT_EQ(json["services"][0]["missed"], 1);
  EXPECT_EQ(json["end_to_end"][0]["count"], 99);
}

TEST(Latency, TheLightHasItsSourceAndItsMissedRefreshes) {
  History history(60);
  for (int i = 0; i < 3; ++i) {
    auto lit = mark(Stage::light, i * 30, i * 30 + 1);
    lit.detail = msg::detail_of({msg::LightSource::kernel, i == 2 ? 3u : 1u});
    history.add("projector", frame(static_cast<std::uint64_t>(i), 0, {lit}), 0);
    lit.detail = msg::detail_of({msg::LightSource::window, 1});
    history.add("projector2", frame(static_cast<std::uint64_t>(i), 0, {lit}), 0);
  }
  const auto table = table_of(history);
  EXPECT_THAT(print_latency(table),
              HasSubstr("light of projector: 2 refreshes without a new frame, 1 frames"));
  EXPECT_THAT(print_latency(table), HasSubstr("times by the kernel\n"));
  const auto lights = to_json(table)["light"];
  EXPECT_EQ(lights["projector"]["times_by"], "kernel");
  EXPECT_EQ(lights["projector"]["missed_refreshes"], 2);
  EXPECT_EQ(lights["projector2"]["missed_refreshes"], 0);
}

TEST(Latency, OfNothingIsAnEmptyPage) {
  const auto table = table_of(History(60));
  EXPECT_TRUE(table.stages.empty());
  EXPECT_FALSE(print_latency(table).empty());
}

}  // namespace
}  // namespace handcast::supervisor
