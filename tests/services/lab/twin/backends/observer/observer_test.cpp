// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "services/lab/twin/backends/observer/live_judge.hpp"
#include "services/lab/twin/backends/observer/live_score.hpp"
#include "services/observer/score_log.hpp"

namespace handcast::observer {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

twin::FrameScore score_of(std::int64_t display_ns, float error_mm, std::size_t points) {
  twin::FrameScore score;
  score.display_ns = display_ns;
  auto& hand = score.hands.emplace_back();
  hand.interior_mm.assign(points, error_mm);
  hand.interior_px.assign(points, 2 * error_mm);
  hand.hand_px = hand.lit_px = hand.union_px = 100;
  return score;
}

TEST(LiveScore, ReportsWhatItWasGiven) {
  LiveScore scores;
  scores.add(score_of(1, 2.0f, 5000), 1);
  const auto json = scores.to_json();
  EXPECT_NEAR(json.at("interior_mm").at("p95").get<double>(), 2.0, 1e-6);
  EXPECT_NEAR(json.at("coverage").get<double>(), 1.0, 1e-6);
}

TEST(LiveScore, ThinningKeepsTheDistribution) {
  LiveScore scores;
  auto score = score_of(1, 0, 10'000);
  for (std::size_t i = 0; i < 10'000; ++i)
    score.hands[0].interior_mm[i] = static_cast<float>(i) / 1000;
  scores.add(score, 0);
  EXPECT_NEAR(scores.to_json().at("interior_mm").at("mean").get<double>(), 5.0, 0.05);
  EXPECT_NEAR(scores.to_json().at("interior_mm").at("p95").get<double>(), 9.5, 0.1);
}

TEST(LiveScore, ForgetsWhatIsOlderThanTwoWindows) {
  LiveScore scores(10 * kSecond_ns);
  for (int second = 0; second < 10; ++second)
    scores.add(score_of(second * kSecond_ns, 50.0f, 10), 0);
  for (int second = 10; second < 31; ++second)
    scores.add(score_of(second * kSecond_ns, 1.0f, 10), 0);
  EXPECT_NEAR(scores.to_json().at("interior_mm").at("mean").get<double>(), 1.0, 1e-6);
}

TEST(LiveScore, AlwaysCoversAtLeastOneWindow) {
  LiveScore scores(10 * kSecond_ns);
  for (int second = 0; second <= 20; ++second)
    scores.add(score_of(second * kSecond_ns, 1.0f, 10), 0);
  EXPECT_GE(scores.to_json().at("frames").get<int>(), 10);
}

TEST(LiveJudge, TheScoreDoesNotDependOnWhenTheRigWasStarted) {
  config::Rig rig;
  const auto calibration = calib::reference_rig();
  const std::int64_t epoch_ns = 123 * kSecond_ns;
  auto at_zero = LiveJudge::create(rig, calibration, 0);
  auto later = LiveJudge::create(rig, calibration, epoch_ns);
  ASSERT_TRUE(at_zero) << at_zero.error().what;
  ASSERT_TRUE(later);

  msg::Projection dark;
  dark.width_px = static_cast<std::uint32_t>(calibration.projector.width_px);
  dark.height_px = static_cast<std::uint32_t>(calibration.projector.height_px);
  dark.lit_ns = kSecond_ns / 2;
  const auto expected = (*at_zero)->score(dark);
  dark.lit_ns += epoch_ns;
  const auto shifted = (*later)->score(dark);
  ASSERT_EQ(expected.hands.size(), 1u);
  ASSERT_EQ(shifted.hands.size(), 1u);
  EXPECT_GT(expected.hands[0].hand_px, 0);
  EXPECT_EQ(shifted.hands[0].hand_px, expected.hands[0].hand_px);
  EXPECT_EQ(shifted.hands[0].speed_m_s, expected.hands[0].speed_m_s);
  EXPECT_EQ(shifted.hands[0].lit_px, 0);
}

TEST(ScoreLog, ScoresAreLoggedAtFirstAMinuteLaterThenHourlyAndWhenTheyChange) {
  constexpr std::int64_t kLook_ns = 5 * kSecond_ns;
  ScoreLog log;
  std::int64_t now_ns = 0;
  const auto lines = [&](int looks, const LoggedScores& scores) {
    int count = 0;
    for (int i = 0; i < looks; ++i) count += log.is_due(now_ns += kLook_ns, scores);
    return count;
  };
  constexpr int kHour = 3600 / 5;
  constexpr LoggedScores kUsual{8, 0.98, 0.02};
  EXPECT_EQ(lines(14, kUsual), 2) << "at once, and when the rig has settled";
  EXPECT_EQ(lines(9 * kHour, kUsual), 9);
  EXPECT_EQ(lines(kHour / 2, {9, 0.97, 0.03}), 0) << "not a change that a person sees";
  EXPECT_EQ(lines(kHour / 4, {8, 0.60, 0.02}), 1) << "a third of the hand is dark";
  EXPECT_EQ(lines(kHour / 4, kUsual), 1) << "as before";
  EXPECT_EQ(lines(kHour / 4, {20, 0.98, 0.02}), 1);
  int restless = 0;
  for (int i = 0; i < kHour; ++i) restless += lines(1, {i % 2 ? 20.0 : 4.0, 0.98, 0.02});
  EXPECT_LE(restless, 60) << "once a minute at most";
}

}  // namespace
}  // namespace handcast::observer
