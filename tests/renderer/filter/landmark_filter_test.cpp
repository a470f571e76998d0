// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/landmark_filter.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "config/settings/choice.hpp"
#include "tests/milliseconds.hpp"

namespace handcast::renderer {
namespace {

config::Filter settings(const char* method, double blend_ms = 0) {
  config::Filter filter;
  filter.method = *config::choice_named<config::FilterMethod>(method);
  filter.blend_ms = blend_ms;
  filter.blend_px = 100;  // larger than all jumps here; another test is about the bound
  return filter;
}

/// A tracker whose landmarks all move at `velocity_px_s`.
struct Line {
  glm::vec2 velocity_px_s{0};
  LandmarkPoints at(std::int64_t time_ns) const {
    LandmarkPoints points;
    for (int i = 0; i < kLandmarks; ++i)
      points[i] =
          glm::vec2(300 + 3 * i, 200 + 5 * i) + velocity_px_s * static_cast<float>(time_ns * 1e-9);
    return points;
  }
  TrackerAt function() const {
    return [*this](std::int64_t time_ns) { return std::optional(at(time_ns)); };
  }
};

msg::HandLandmarks seen(const LandmarkPoints& tracker, glm::vec2 offset_px) {
  msg::HandLandmarks hand;
  hand.presence = 1;
  for (int i = 0; i < kLandmarks; ++i)
    hand.points[i] = {tracker[i].x + offset_px.x, tracker[i].y + offset_px.y, 1.0f};
  return hand;
}

/// Adds detections with `offset_px` every 16 ms, 16 ms late, and calls at() every 2 ms. Returns the
/// time of the last call.
std::int64_t run(LandmarkFilter& filter, const Line& line, glm::vec2 offset_px,
                 std::int64_t from_ms, std::int64_t to_ms) {
  for (std::int64_t now_ms = from_ms; now_ms <= to_ms; now_ms += 2) {
    if (now_ms % 16 == 0)
      filter.detection(now_ms * kMs, (now_ms - 16) * kMs,
                       seen(line.at((now_ms - 16) * kMs), offset_px), line.function());
    filter.at(now_ms * kMs, (now_ms + 4) * kMs, line.at((now_ms + 4) * kMs));
  }
  return to_ms * kMs;
}

glm::vec2 offset_at(LandmarkFilter& filter, const Line& line, std::int64_t now_ns,
                    int landmark = 7) {
  const auto points = filter.at(now_ns, now_ns + 4 * kMs, line.at(now_ns + 4 * kMs));
  return points ? (*points)[landmark] - line.at(now_ns + 4 * kMs)[landmark] : glm::vec2(0);
}

class EveryFilter : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Filters, EveryFilter, ::testing::Values("naive", "kalman", "paper"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(EveryFilter, SaysNothingBeforeTheFirstDetection) {
  const auto filter = make_landmark_filter(settings(GetParam(), 6));
  EXPECT_FALSE(filter->at(0, 4 * kMs, Line{}.at(0)));
}

TEST_P(EveryFilter, FindsAConstantOffsetOfAStillHand) {
  const auto filter = make_landmark_filter(settings(GetParam(), 6));
  const Line still;
  const auto now_ns = run(*filter, still, {12, -7}, 0, 400);
  EXPECT_NEAR(offset_at(*filter, still, now_ns).x, 12, 0.1);
  EXPECT_NEAR(offset_at(*filter, still, now_ns).y, -7, 0.1);
}

TEST_P(EveryFilter, AMissingPointKeepsWhatIsKnownOfIt) {
  const auto filter = make_landmark_filter(settings(GetParam()));
  const Line still;
  run(*filter, still, {12, -7}, 0, 200);
  auto without_seven = seen(still.at(0), {20, 0});
  without_seven.points[7].confidence = 0;
  filter->detection(202 * kMs, 200 * kMs, without_seven, still.function());
  EXPECT_NEAR(offset_at(*filter, still, 202 * kMs, 7).x, 12, 0.5);
  EXPECT_GT(offset_at(*filter, still, 202 * kMs, 8).x, 13.5);
}

TEST_P(EveryFilter, APointNeverSeenGoesWithTheOthers) {
  const auto filter = make_landmark_filter(settings(GetParam()));
  const Line still;
  auto without_seven = seen(still.at(0), {10, 4});
  without_seven.points[7].confidence = 0;
  filter->detection(2 * kMs, 0, without_seven, still.function());
  EXPECT_NEAR(offset_at(*filter, still, 2 * kMs, 7).x, 10, 0.1);
}

TEST_P(EveryFilter, ADetectionWithoutAnyPointChangesNothing) {
  const auto filter = make_landmark_filter(settings(GetParam()));
  filter->detection(2 * kMs, 0, msg::HandLandmarks{}, Line{}.function());
  EXPECT_FALSE(filter->at(4 * kMs, 8 * kMs, Line{}.at(0)));
}

TEST_P(EveryFilter, AnOlderDetectionThatComesLaterIsNotTakenForTheNewest) {
  const auto filter = make_landmark_filter(settings(GetParam()));
  const Line still;
  run(*filter, still, {12, 0}, 0, 160);
  filter->detection(162 * kMs, 100 * kMs, seen(still.at(0), {-30, 0}), still.function());
  EXPECT_NEAR(offset_at(*filter, still, 162 * kMs).x, 12, 0.1);
}

TEST_P(EveryFilter, FadesOutSmoothlyWhenDetectionsStayAway) {
  const auto filter = make_landmark_filter(settings(GetParam()));  // lost_ms 300
  const Line still;
  const auto lost_ns = run(*filter, still, {20, 0}, 0, 320);  // the last one was seen at 304 ms
  EXPECT_NEAR(offset_at(*filter, still, lost_ns + 270 * kMs).x, 20, 0.1);
  float before = 20;
  for (int ms = 272; ms < 420; ms += 2) {
    const float now = offset_at(*filter, still, lost_ns + ms * kMs).x;
    EXPECT_LE(now, before + 1e-4f);
    EXPECT_GT(now, before - 1.0f);
    before = now;
  }
  EXPECT_FALSE(filter->at(lost_ns + 420 * kMs, lost_ns + 424 * kMs, still.at(0)));
}

TEST_P(EveryFilter, BlendsItsFirstCorrectionIn) {
  const auto filter = make_landmark_filter(settings(GetParam(), 8));
  const Line still;
  for (int ms = 0; ms < 20; ms += 1) filter->at(ms * kMs, (ms + 4) * kMs, still.at(0));
  filter->detection(20 * kMs, 4 * kMs, seen(still.at(0), {40, 0}), still.function());
  float before = 0;
  for (int ms = 20; ms < 100; ms += 1) {
    const float now = offset_at(*filter, still, ms * kMs).x;
    EXPECT_LT(std::abs(now - before), 40 * (1 - std::exp(-1 / 8.0f)) + 0.01f) << ms;
    before = now;
  }
  EXPECT_NEAR(before, 40, 0.1);
}

TEST(PaperFilter, DelayedDetectionsOfAMovingHandAreCarriedToTheLight) {
  const auto filter = make_landmark_filter(settings("paper"));
  const Line fast{{800, -300}};
  const auto now_ns = run(*filter, fast, {12, -7}, 0, 400);
  EXPECT_NEAR(offset_at(*filter, fast, now_ns).x, 12, 0.1);
  EXPECT_NEAR(offset_at(*filter, fast, now_ns).y, -7, 0.1);
}

TEST(NaiveFilter, TrailsAMovingHandByTheAgeOfItsLandmarks) {
  const auto filter = make_landmark_filter(settings("naive"));
  const Line fast{{1000, 0}};
  const auto now_ns = run(*filter, fast, {0, 0}, 0, 400);
  EXPECT_NEAR(offset_at(*filter, fast, now_ns).x, -20, 0.5);  // 16 ms old and drawn 4 ms ahead
}

TEST(IdealFilter, SaysWhatTheOracleSaysAtTheTimeOfTheLight) {
  const Line truth{{700, 0}};
  const auto filter = make_landmark_filter(
      settings("ideal"), [&](std::int64_t time_ns) { return std::optional(truth.at(time_ns)); });
  const auto points = filter->at(100 * kMs, 104 * kMs, Line{}.at(0));
  ASSERT_TRUE(points);
  EXPECT_EQ(*points, truth.at(104 * kMs));
}

TEST(IdealFilter, CorrectsNothingWithoutAnOracle) {
  EXPECT_FALSE(make_landmark_filter(settings("ideal"))->at(100 * kMs, 104 * kMs, Line{}.at(0)));
}

TEST(NoFilter, NeverCorrects) {
  const auto filter = make_landmark_filter(settings("none"));
  run(*filter, Line{}, {10, 10}, 0, 100);
  EXPECT_FALSE(filter->at(100 * kMs, 104 * kMs, Line{}.at(0)));
}

TEST(PaperFilter, TakesTheTrackerAsItWasDrawnThen) {
  const auto filter = make_landmark_filter(settings("paper"));
  const Line drawn;
  for (int ms = 0; ms < 40; ms += 1) filter->at(ms * kMs, (ms + 4) * kMs, drawn.at(0));
  const TrackerAt known_now = [&](std::int64_t) {
    auto points = drawn.at(0);
    for (auto& point : points) point.x += 30;
    return std::optional(points);
  };
  filter->detection(40 * kMs, 24 * kMs, seen(drawn.at(0), {5, 0}), known_now);
  EXPECT_NEAR(offset_at(*filter, drawn, 40 * kMs).x, 5, 1e-3);
}

TEST(KalmanFilter, LeavesOutAWildPointButFollowsAJumpThatStays) {
  const auto filter = make_landmark_filter(settings("kalman"));
  const Line still;
  run(*filter, still, {3, 0}, 0, 320);
  for (int n = 1; n <= 20; ++n) {
    auto wild = seen(still.at(0), {3, 0});
    wild.points[7].x_px += 80;
    filter->detection((320 + 16 * n) * kMs, (304 + 16 * n) * kMs, wild, still.function());
    const float moved = offset_at(*filter, still, (320 + 16 * n) * kMs, 7).x;
    if (n <= 2) {
      EXPECT_NEAR(moved, 3, 0.5) << n;
    } else if (n >= 15) {
      EXPECT_NEAR(moved, 83, 1) << n;
    }
    EXPECT_NEAR(offset_at(*filter, still, (320 + 16 * n) * kMs, 8).x, 3, 0.5);
  }
}

TEST(KalmanFilter, FollowsASteadyHandWithoutLag) {
  const auto filter = make_landmark_filter(settings("kalman"));
  const Line fast{{800, -300}};
  const auto now_ns = run(*filter, fast, {0, 0}, 0, 400);
  EXPECT_NEAR(offset_at(*filter, fast, now_ns).x, 0, 0.5);
}

TEST(Blending, ATrackerThatJumpsMovesTheLightOnlyBitByBit) {
  const auto filter = make_landmark_filter(settings("paper", 8));
  const Line fast{{500, 0}};
  run(*filter, fast, {10, 0}, 0, 320);
  float before = 0;
  for (int ms = 322; ms < 380; ++ms) {
    LandmarkPoints tracker = fast.at((ms + 4) * kMs);
    if (ms == 350) filter->tracker_sample(ms * kMs);
    if (ms >= 350)
      for (auto& point : tracker) point.x += 16;
    const float now =
        (*filter->at(ms * kMs, (ms + 4) * kMs, tracker))[3].x - fast.at((ms + 4) * kMs)[3].x;
    if (ms > 322) {
      EXPECT_LT(std::abs(now - before), 16 * (1 - std::exp(-1 / 8.0f)) + 0.1f) << ms;
    }
    if (ms == 350) {
      EXPECT_NEAR(now, before, 0.1);  // nothing moves in the frame of the jump
    }
    before = now;
  }
  EXPECT_NEAR(before, 26, 0.6);
}

TEST(Blending, NoMoreThanItsBoundIsHeldBack) {
  config::Filter bounded = settings("paper", 8);
  bounded.blend_px = 1.5;
  const auto filter = make_landmark_filter(bounded);
  const Line still;
  const auto now_ns = run(*filter, still, {10, 0}, 0, 320);
  auto jumped = still.at(0);
  for (auto& point : jumped) point.x += 16;
  filter->tracker_sample(now_ns + kMs);
  EXPECT_NEAR((*filter->at(now_ns + kMs, now_ns + 5 * kMs, jumped))[3].x - still.at(0)[3].x,
              26 - 1.5, 0.1);
}

TEST(Blending, AHandThatComesBackIsNotDraggedFromWhereItLeft) {
  const auto filter = make_landmark_filter(settings("paper", 8));
  const Line still;
  run(*filter, still, {10, 0}, 0, 320);
  LandmarkPoints elsewhere = still.at(0);
  for (auto& point : elsewhere) point += glm::vec2(200, 100);
  filter->tracker_sample(480 * kMs);
  EXPECT_NEAR((*filter->at(480 * kMs, 484 * kMs, elsewhere))[3].x - elsewhere[3].x, 10, 0.5);
}

TEST(KalmanFilter, ADetectionThatIsElsewhereAltogetherIsNotBelievedAtOnce) {
  const auto filter = make_landmark_filter(settings("kalman"));
  const Line still;
  run(*filter, still, {3, 0}, 0, 320);
  filter->detection(336 * kMs, 320 * kMs, seen(still.at(0), {150, 40}), still.function());
  EXPECT_NEAR(offset_at(*filter, still, 336 * kMs).x, 3, 0.5);
}

}  // namespace
}  // namespace handcast::renderer
