// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "config/settings/choice.hpp"
#include "renderer/filter/landmark_filter.hpp"

/// The discrete simulation of the paper ("Temporal Filtering") on an artificial motion: a biased
/// tracker at 110.6 Hz, 10 ms late; a detector that takes 16 ms, back to back, with 1 px of noise;
/// light at 525 Hz.
namespace handcast::renderer {
namespace {

struct World {
  double seconds = 8;
  std::vector<double> tracker_s;
  std::vector<LandmarkPoints> tracker;

  World() {
    for (double t = 0; t < seconds; t += 1 / 110.6) {
      tracker_s.push_back(t);
      tracker.push_back(biased(t));
    }
  }

  static LandmarkPoints truth(double t) {
    LandmarkPoints points;
    for (int i = 0; i < kLandmarks; ++i) {
      const double wave = 0.3 * i;
      points[i] = {360 + 4 * i + 60 * std::sin(2.1 * t) + 25 * std::sin(5.3 * t + wave) +
                       5 * std::sin(11 * t + 2 * wave),
                   270 + 6 * i + 45 * std::cos(1.7 * t) + 20 * std::sin(4.1 * t + wave) +
                       5 * std::cos(9 * t + wave)};
    }
    return points;
  }

  /// The error of a tracker: scale, shift and a slow drift per point.
  static LandmarkPoints biased(double t) {
    LandmarkPoints points = truth(t);
    for (int i = 0; i < kLandmarks; ++i) {
      const glm::vec2 drift{3 * std::sin(2.3 * t + 1.7 * i), 3 * std::cos(3.1 * t + 0.9 * i)};
      points[i] = (points[i] - glm::vec2(360, 270)) * 1.03f + glm::vec2(366, 263) + drift;
    }
    return points;
  }

  /// P at `t` from the samples that had arrived by `now`.
  LandmarkPoints known(double t, double now) const {
    std::size_t newest = 1;
    while (newest + 1 < tracker_s.size() && tracker_s[newest + 1] + 0.010 <= now) ++newest;
    std::size_t k = 1;
    while (k < newest && tracker_s[k] < t) ++k;
    const auto a = static_cast<float>((t - tracker_s[k - 1]) / (tracker_s[k] - tracker_s[k - 1]));
    LandmarkPoints points;
    for (int i = 0; i < kLandmarks; ++i) points[i] = glm::mix(tracker[k - 1][i], tracker[k][i], a);
    return points;
  }
  bool sample_arrives(double from, double to) const {
    for (const double t : tracker_s)
      if (t + 0.010 > from && t + 0.010 <= to) return true;
    return false;
  }
};

std::int64_t ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

struct Score {
  double mean_px = 0, jitter_px = 0;
};

Score simulate(const World& world, const config::Filter& settings) {
  const auto filter = make_landmark_filter(settings);
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 1);
  const double frame = 1 / 525.0;
  double seen_at = 0.06, error = 0, jitter = 0;
  int count = 0;
  std::array<LandmarkPoints, 3> errors{};
  for (double now = 0.06; now < world.seconds - 0.1; now += frame) {
    if (world.sample_arrives(now - frame, now)) filter->tracker_sample(ns(now));
    if (now >= seen_at + 0.016) {
      msg::HandLandmarks hand;
      const auto truth = World::truth(seen_at);
      for (int i = 0; i < kLandmarks; ++i)
        hand.points[i] = {truth[i].x + noise(random), truth[i].y + noise(random), 1};
      filter->detection(ns(now), ns(seen_at), hand,
                        [&](std::int64_t t) { return std::optional(world.known(t * 1e-9, now)); });
      seen_at = now;
    }
    const auto tracker = world.known(now, now);
    const auto points = filter->at(ns(now), ns(now), tracker).value_or(tracker);
    if (now < 0.5) continue;
    const auto truth = World::truth(now);
    errors = {errors[1], errors[2], {}};
    for (int i = 0; i < kLandmarks; ++i) {
      errors[2][i] = points[i] - truth[i];
      error += glm::length(errors[2][i]);
      if (now > 0.52)
        jitter += std::pow(glm::length(errors[2][i] - 2.0f * errors[1][i] + errors[0][i]), 2);
      ++count;
    }
  }
  return {error / count, std::sqrt(jitter / count)};
}

config::Filter method(const char* name, double blend_ms) {
  config::Filter settings;
  settings.method = *config::choice_named<config::FilterMethod>(name);
  settings.blend_ms = blend_ms;
  return settings;
}

TEST(FilterRanking, ThePaperBeatsWhatUsesOneSensorOnlyAndBlendingIsSmoother) {
  const World world;
  std::map<std::string, Score> scores{{"baseline", simulate(world, method("none", 0))},
                                      {"naive", simulate(world, method("naive", 0))},
                                      {"kalman", simulate(world, method("kalman", 0))},
                                      {"paper", simulate(world, method("paper", 0))},
                                      {"blended", simulate(world, method("paper", 6))}};
  for (const auto& [name, score] : scores)
    printf("  %-14s mean %.2f px, jitter %.2f px\n", name.c_str(), score.mean_px, score.jitter_px);
  EXPECT_LT(scores["paper"].mean_px, 0.5 * scores["baseline"].mean_px);
  EXPECT_LT(scores["paper"].mean_px, scores["naive"].mean_px);
  EXPECT_LT(scores["kalman"].mean_px, scores["naive"].mean_px);
  EXPECT_LT(scores["paper"].mean_px, scores["kalman"].mean_px);
  EXPECT_LT(scores["blended"].mean_px, 1.05 * scores["paper"].mean_px);
  EXPECT_LT(scores["blended"].jitter_px, 0.4 * scores["paper"].jitter_px);
}

}  // namespace
}  // namespace handcast::renderer
