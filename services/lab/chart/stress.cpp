// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/stress.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace handcast::chart {
namespace {

/// The error of the light: a stress that only the landmarks show would leave the registration out.
constexpr std::string_view kLight = "interior_mm_mean", kLightTitle = "interior error, mean, mm";

constexpr std::array kStresses{
    Stress{"twin.tracker.age_ms", "tracker age", "ms", 1, "", kLight, kLightTitle},
    Stress{"twin.tracker.dropout", "tracker samples lost", "%", 100, "", kLight, kLightTitle},
    Stress{"twin.detector.noise_px", "landmark noise", "px", 1, "", kLight, kLightTitle},
    Stress{"twin.detector.age_ms", "landmark age", "ms, back to back (100 ms: 10 Hz)", 1, "",
           kLight, kLightTitle},
    Stress{"twin.image.holes", "holes in the camera image", "% of the hand", 100, "", "coverage",
           "hand without light, %", true},
    Stress{"twin.speed", "hand speed", "m/s", 1, "hand_speed_m_s_p95", kLight, kLightTitle},
};

/// True if the only axis of a run, motion and seed aside, is the setting of the stress. The caller
/// excludes the runs of ladders, in which the speed is not a stress.
bool is_under(const Run& run, const Stress& stress) {
  const auto turned = run.turned();
  if (stress.setting == "twin.speed") return turned.empty() && !run.setting("twin.speed").empty();
  return turned.size() == 1 && turned.front() == stress.setting;
}

std::optional<Point> point_of(const Stress& stress, double setting, const Runs& runs) {
  const auto x = stress.measure.empty() ? std::optional(setting * stress.scale)
                                        : mean_of(runs, std::string(stress.measure));
  const auto y = mean_of(runs, std::string(stress.harm));
  if (!x || !y) return std::nullopt;
  return Point{*x, stress.of_one ? 100 * (1 - *y) : *y};
}

}  // namespace

std::span<const Stress> stresses() { return kStresses; }

std::vector<StressLine> lines_of(const Results& results, const Stress& stress) {
  std::map<std::string, bool> of_ladder;
  for (const auto& source : results.sources) of_ladder[source.plan] = source.ladder;
  const auto runs =
      results.select([&](const Run& run) { return !of_ladder[run.plan] && is_under(run, stress); });
  std::vector<StressLine> lines;
  for (const auto& variant : variants_of(runs)) {
    std::map<double, Runs> by_level;
    for (const auto* run : of_variant(runs, variant))
      if (const auto level = number_of(run->setting(std::string(stress.setting))))
        by_level[*level].push_back(run);
    StressLine line{method_of(variant), {}, {}, {}};
    for (const auto& [level, at_level] : by_level) {
      const auto point = point_of(stress, level, at_level);
      if (!point) continue;
      line.points.push_back(*point);
      line.levels.push_back(level);
    }
    line.breakdown = breakdown_point(line.points);
    if (!line.points.empty()) lines.push_back(line);
  }
  return lines;
}

}  // namespace handcast::chart
