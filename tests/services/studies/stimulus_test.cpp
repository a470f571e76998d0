// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/stimulus.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace handcast::study {
namespace {

StimulusSettings small() {
  StimulusSettings settings;
  settings.width_px = 480;
  settings.height_px = 360;
  settings.px_per_mm = 1.3;
  settings.content = "builtin:white";
  return settings;
}

using Picture = std::vector<std::uint32_t>;

/// Which pixels have light: skin in the dim light of the room has at most 33 of 255.
std::vector<bool> lit(Stimulus& stimulus, double time_s, double delay_ms, Condition condition) {
  const auto picture = stimulus.draw(time_s, delay_ms, condition);
  std::vector<bool> is_lit;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) is_lit.push_back((picture.at(x, y) & 0xff) > 45);
  return is_lit;
}

int count(const std::vector<bool>& pixels) {
  return static_cast<int>(std::ranges::count(pixels, true));
}

int differences(const std::vector<bool>& a, const std::vector<bool>& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] != b[i];
  return sum;
}

/// The pixels where the hand is now and its light, that was right `delay_ms` ago, falls.
std::vector<bool> overlap(Stimulus& stimulus, double time_s, double delay_ms) {
  const auto now = lit(stimulus, time_s, 0, Condition::baseline),
             then = lit(stimulus, time_s - 1e-3 * delay_ms, 0, Condition::baseline);
  std::vector<bool> both;
  for (std::size_t i = 0; i < now.size(); ++i) both.push_back(now[i] && then[i]);
  return both;
}

TEST(Stimulus, LateLightIsThatOfTheHandExactlySoLongAgo) {
  auto stimulus = Stimulus::open(small());
  ASSERT_TRUE(stimulus) << stimulus.error().what;
  constexpr double kTime_s = 1.2, kDelay_ms = 23.4;
  const auto late = lit(*stimulus, kTime_s, kDelay_ms, Condition::baseline);
  const int exact = differences(late, overlap(*stimulus, kTime_s, kDelay_ms));
  EXPECT_LT(exact, 0.01 * count(late));
  // Half a refresh of 60 Hz beside it is another picture.
  EXPECT_GT(differences(late, overlap(*stimulus, kTime_s, kDelay_ms + 8)), 4 * exact + 40);
  EXPECT_GT(differences(late, overlap(*stimulus, kTime_s, kDelay_ms - 8)), 4 * exact + 40);
}

TEST(Stimulus, TheFillCoversWhatLateLightLeavesAndChangesNothingOfPerfectLight) {
  auto stimulus = Stimulus::open(small());
  ASSERT_TRUE(stimulus);
  const int perfect = count(lit(*stimulus, 1.2, 0, Condition::baseline)),
            late = count(lit(*stimulus, 1.2, 12, Condition::baseline)),
            filled = count(lit(*stimulus, 1.2, 12, Condition::fill));
  EXPECT_LT(late, 0.97 * perfect);
  EXPECT_GT(filled, 0.985 * perfect);
  EXPECT_LT(differences(lit(*stimulus, 1.2, 0, Condition::baseline),
                        lit(*stimulus, 1.2, 0, Condition::fill)),
            0.003 * perfect);
}

TEST(Stimulus, AHandHasItsOwnSizeOnTheScreen) {
  auto settings = small();
  settings.px_per_mm = 0.9;
  auto small_one = Stimulus::open(settings);
  settings.px_per_mm *= 0.5;
  auto smaller = Stimulus::open(settings);
  const int area = count(lit(*small_one, 0, 0, Condition::baseline));
  EXPECT_NEAR(count(lit(*smaller, 0, 0, Condition::baseline)), 0.25 * area, 0.03 * area);
}

TEST(Stimulus, WhatCannotBeShownIsNamed) {
  auto settings = small();
  settings.motion = "builtin:nowhere";
  EXPECT_THAT(Stimulus::open(settings).error().what, testing::HasSubstr("nowhere"));
  settings = small();
  settings.content = "missing.png";
  EXPECT_THAT(Stimulus::open(settings).error().what, testing::HasSubstr("missing.png"));
}

}  // namespace
}  // namespace handcast::study
