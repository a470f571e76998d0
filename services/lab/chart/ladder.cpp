// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace handcast::chart {
namespace {

double speed_of(const Run& run) { return number_of(run.setting("twin.speed")).value_or(1); }

Runs at_speed(const Runs& runs, double speed) {
  Runs selected;
  std::ranges::copy_if(runs, std::back_inserter(selected),
                       [&](const Run* run) { return speed_of(*run) == speed; });
  return selected;
}

std::vector<double> speeds_of(const Runs& runs) {
  std::set<double> speeds;
  for (const auto* run : runs) speeds.insert(speed_of(*run));
  if (speeds.empty()) return {};
  const double natural = speeds.contains(1) ? 1 : *speeds.begin(), fastest = *speeds.rbegin();
  return natural == fastest ? std::vector{natural} : std::vector{natural, fastest};
}

Standing standing_of(const std::string& variant, double speed, const Runs& runs) {
  return {method_of(variant),
          speed,
          runs.size(),
          mean_of(runs, "motion_to_photon_ms"),
          mean_of(runs, "interior_mm_mean"),
          mean_of(runs, "interior_mm_p95"),
          mean_of(runs, "coverage"),
          mean_of(runs, "spill"),
          mean_of(runs, "landmark_jitter_px"),
          mean_of(runs, "detector_age_ms"),
          mean_of(runs, "frame_us_p50")};
}

/// The variant whose measured frame time is used for a method; "" if that of its rig is used. The
/// detector does not delay the frames, and methods that cannot be built are given the time of
/// handcast.
std::string timed_as(const Method& method) {
  if (method.variant == "paper") return "";
  return method.variant == "paper_at_our_speed" || method.variant == "ideal" || method.detects
             ? "handcast"
             : method.variant;
}

/// Replaces the simulated software time in photon_ms by the measured time of a frame.
void take_own_leg(Standing& standing, const Runs& runs, std::optional<double> frame_us) {
  const auto simulated_ms = mean_of(runs, "software_ms");
  if (standing.photon_ms && simulated_ms && frame_us)
    *standing.photon_ms += *frame_us / 1e3 - *simulated_ms;
}

}  // namespace

std::vector<Standing> Ladder::at(double speed) const {
  std::vector<Standing> selected;
  std::ranges::copy_if(standings, std::back_inserter(selected),
                       [&](const Standing& standing) { return standing.speed == speed; });
  return selected;
}

Ladder ladder_of(const Results& results) {
  const auto runs = results.ladder();
  const auto timing = results.select([](const Run& run) { return run.plan == "times"; });
  Ladder ladder{speeds_of(runs), {}, !timing.empty()};
  for (const double speed : ladder.speeds)
    for (const auto& variant : variants_of(runs)) {
      auto standing = standing_of(variant, speed, of_variant(at_speed(runs, speed), variant));
      const auto timed = at_speed(timing, speed);
      if (ladder.timed_alone)
        standing.frame_us = mean_of(of_variant(timed, variant), "frame_us_p50");
      take_own_leg(standing, of_variant(at_speed(runs, speed), variant),
                   mean_of(of_variant(timed, timed_as(standing.method)), "frame_us_p50"));
      if (standing.p95_mm) ladder.standings.push_back(standing);
    }
  return ladder;
}

std::string name_of_speed(double speed) {
  return speed == 1 ? "natural speed" : fmt::format("{:g} times as fast", speed);
}

}  // namespace handcast::chart
