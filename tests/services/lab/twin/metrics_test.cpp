// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/metrics.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace handcast::twin {
namespace {

FrameScore::Hand hand_at(double speed_m_s, float error_px, Side side = Side::left) {
  FrameScore::Hand hand;
  hand.side = side;
  hand.speed_m_s = speed_m_s;
  hand.interior_px.assign(100, error_px);
  hand.interior_mm.assign(100, error_px / 2);
  hand.hand_px = 1000;
  hand.lit_px = 900;
  hand.spill_px = 50;
  hand.union_px = 1050;
  hand.seam_px = 12;
  hand.lag_px_s = 40;
  hand.speed2_px_s2 = 10'000;
  return hand;
}

TEST(Metrics, EdgesOfTheLightInsideTheHandMakeDelaysEasierToNotice) {
  const auto jnd_ms = [](double seam_px) {
    Metrics metrics;
    FrameScore score;
    score.hands = {hand_at(0.2, 1)};
    score.hands[0].seam_px = seam_px;
    score.hands[0].outline_px = 600;
    metrics.add(score);
    const auto json = metrics.to_json();
    EXPECT_NEAR(json["late_jnds"].get<double>() * json["jnd_ms"].get<double>(), 4, 1e-9);
    return json["jnd_ms"].get<double>();
  };
  EXPECT_NEAR(jnd_ms(300), 3.05, 0.05);
  EXPECT_NEAR(jnd_ms(5000), jnd_ms(300), 1e-9);
  EXPECT_GT(jnd_ms(0), 2 * jnd_ms(300));
}

TEST(Metrics, TheRungsAreSharesOfTheHandsThatWereDrawn) {
  Metrics metrics;
  for (int i = 0; i < 3; ++i) metrics.add_rung(msg::Rung::landmarks);
  metrics.add_rung(msg::Rung::hold);
  const auto rungs = metrics.to_json()["rungs"];
  EXPECT_EQ(rungs.size(), msg::kRungs);
  EXPECT_DOUBLE_EQ(rungs["landmarks"], 0.75);
  EXPECT_DOUBLE_EQ(rungs["hold"], 0.25);
  EXPECT_DOUBLE_EQ(rungs["register"], 0);
}

TEST(Metrics, LightWithoutAHandCountsAsSpill) {
  Metrics metrics;
  FrameScore with_hand, without;
  with_hand.hands = {hand_at(0.05, 1)};
  without.stray_px = 150;
  metrics.add(with_hand);
  metrics.add(without);
  const auto json = metrics.to_json();
  EXPECT_DOUBLE_EQ(json["spill"], 0.2);
  EXPECT_DOUBLE_EQ(json["iou"], 0.75);
  EXPECT_DOUBLE_EQ(json["coverage"], 0.9);
}

TEST(Metrics, EveryFigureComesOutUnderItsName) {
  Metrics metrics;
  FrameScore score;
  score.hands = {hand_at(0.05, 1), hand_at(0.8, 3, Side::right)};
  metrics.add(score);
  const std::vector<msg::StageMark> stages{{msg::Stage::frame, 0, 1000, 901'000},
                                           {msg::Stage::draw, 0, 0, 250'000}};
  metrics.add_stages(stages);
  metrics.add_foldovers(2);
  metrics.add_foldovers(1);
  metrics.set_jitter(0.1, 0.3);
  const auto json = metrics.to_json();
  EXPECT_EQ(json["frames"], 1);
  EXPECT_DOUBLE_EQ(json["interior_px"]["mean"], 2);
  EXPECT_DOUBLE_EQ(json["interior_px"]["p95"], 3);
  EXPECT_DOUBLE_EQ(json["interior_mm"]["p99"], 1.5);
  EXPECT_DOUBLE_EQ(json["coverage"], 0.9);
  EXPECT_DOUBLE_EQ(json["spill"], 0.05);
  EXPECT_DOUBLE_EQ(json["iou"], 900.0 / 1050);
  EXPECT_DOUBLE_EQ(json["seam_px"], 12);
  EXPECT_DOUBLE_EQ(json["jitter_px"], 0.1);
  EXPECT_DOUBLE_EQ(json["landmark_jitter_px"], 0.3);
  EXPECT_EQ(json["foldovers"], 3);
  EXPECT_DOUBLE_EQ(json["equivalent_latency_ms"], 4);
  EXPECT_DOUBLE_EQ(json["frame_us"]["p50"], 900);
  EXPECT_DOUBLE_EQ(json["stage_us"]["draw"]["p99"], 250);
  EXPECT_EQ(json["bins"].size(), 5u);
  EXPECT_EQ(json["bins"]["0-0.1"]["frames"], 1);
  EXPECT_DOUBLE_EQ(json["bins"]["0.6-1.0"]["interior_px"]["mean"], 3);
  EXPECT_EQ(json["bins"][">1.0"]["frames"], 0);
  EXPECT_TRUE(json["bins"][">1.0"]["interior_mm"]["mean"].is_null());
  EXPECT_DOUBLE_EQ(json["hands"]["left"]["interior_px"]["mean"], 1);
  EXPECT_DOUBLE_EQ(json["hands"]["right"]["interior_px"]["p95"], 3);
}

TEST(Metrics, NothingMeasuredIsNullAndNotZero) {
  const auto json = Metrics().to_json();
  for (const char* key : {"coverage", "spill", "iou", "seam_px", "jitter_px",
                          "equivalent_latency_ms", "jnd_ms", "late_jnds"})
    EXPECT_TRUE(json[key].is_null()) << key;
  EXPECT_TRUE(json["frame_us"]["p50"].is_null());
  EXPECT_EQ(json["frames"], 0);
}

TEST(Metrics, PercentilesStayRightOverMoreSamplesThanAreKept) {
  Metrics metrics;
  constexpr int kFrames = 3000;
  for (int i = 0; i < kFrames; ++i) {
    FrameScore score;
    score.hands = {hand_at(0.2, 0)};
    score.hands[0].interior_px.assign(1000, static_cast<float>((i * 7919) % kFrames) / kFrames);
    metrics.add(score);
  }
  const auto json = metrics.to_json();
  EXPECT_NEAR(json["interior_px"]["mean"], 0.5, 0.001);
  EXPECT_NEAR(json["interior_px"]["p95"], 0.95, 0.003);
  EXPECT_NEAR(json["interior_px"]["p99"], 0.99, 0.003);
}

TEST(Metrics, SpeedsFallIntoTheirBins) {
  Metrics metrics;
  for (const double speed : {0.05, 0.1, 0.2, 0.5, 0.9, 1.0, 2.0}) {
    FrameScore score;
    score.hands = {hand_at(speed, 1)};
    metrics.add(score);
  }
  const auto bins = metrics.to_json()["bins"];
  EXPECT_EQ(bins["0-0.1"]["frames"], 2);
  EXPECT_EQ(bins["0.1-0.3"]["frames"], 1);
  EXPECT_EQ(bins["0.3-0.6"]["frames"], 1);
  EXPECT_EQ(bins["0.6-1.0"]["frames"], 2);
  EXPECT_EQ(bins[">1.0"]["frames"], 1);
}

TEST(Metrics, AFrameThatIsLeftDarkMakesTheHeadlineWorse) {
  FrameScore lit;
  lit.hands.resize(1);
  lit.hands[0].interior_mm.assign(100, 1);
  lit.hands[0].interior_px.assign(100, 2);
  FrameScore dark;
  dark.hands.resize(1);
  dark.hands[0].missing_px.assign(100, 40);
  Metrics all_lit, half_dark;
  for (int i = 0; i < 10; ++i) {
    all_lit.add(lit);
    half_dark.add(i % 2 ? lit : dark);
  }
  const auto good = all_lit.to_json(), bad = half_dark.to_json();
  EXPECT_DOUBLE_EQ(good["interior_mm"]["mean"], 1);
  EXPECT_DOUBLE_EQ(good["missing"], 0);
  EXPECT_DOUBLE_EQ(bad["interior_mm"]["mean"], (1 + FrameScore::kMissing_mm) / 2);
  EXPECT_DOUBLE_EQ(bad["interior_mm"]["p95"], FrameScore::kMissing_mm);
  EXPECT_DOUBLE_EQ(bad["interior_px"]["p95"], 40);
  EXPECT_DOUBLE_EQ(bad["missing"], 0.5);
  EXPECT_DOUBLE_EQ(bad["lit_mm"]["mean"], 1) << "beside it: the light that is there";
}

TEST(Metrics, WhatIsDarkOrMoreThan10MmOffIsCountedAlike) {
  FrameScore score;
  score.hands.resize(1);
  score.hands[0].interior_mm = {1, 10, 10.5f, 100};
  score.hands[0].interior_px = {1, 10, 10.5f, 100};
  score.hands[0].missing_px = {30};
  Metrics metrics;
  metrics.add(score);
  EXPECT_DOUBLE_EQ(metrics.to_json()["off_10mm"], 3.0 / 5);
}

TEST(Metrics, TheResidualIsWhatNoDelayExplains) {
  const auto residual_px = [](double lag_px_s) {
    FrameScore score;
    score.hands.resize(1);
    auto& hand = score.hands[0];
    hand.interior_px = hand.interior_mm = {3, 5};
    hand.error2_px2 = 9 + 25;
    hand.lag_px_s = lag_px_s;
    hand.speed2_px_s2 = 2 * 100 * 100;
    Metrics metrics;
    metrics.add(score);
    return metrics.to_json()["residual_px"].get<double>();
  };
  EXPECT_DOUBLE_EQ(residual_px(0), std::sqrt(34 / 2.0)) << "errors across the motion";
  EXPECT_DOUBLE_EQ(residual_px(800), std::sqrt((34 - 32) / 2.0)) << "errors of 3 and 5 px along it";
}

}  // namespace
}  // namespace handcast::twin
