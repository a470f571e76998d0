// SPDX-License-Identifier: Apache-2.0
// Speed against accuracy: every rung of the ladder on the twin, and the goals of the cascade.
//   bench_cascade [--goals FILE]
// Accuracy: twin.toml, with our network on the twin's images, 3 s of each motion; two runs side by
// side. Speed: render() of a swaying hand on one core, alone, the rungs in turns.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>

#include "config/settings/choice.hpp"
#include "ipc/msg/rung.hpp"
#include "tests/bench/cascade_runs.hpp"
#include "tests/bench/frame_pipeline.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

constexpr double kSeconds = 3;
const std::vector<double> kSpeeds{1, 3};
const std::string kStill = "builtin:still";
constexpr int kForJitter =
    12;  ///< of 946 frames a second, more than the 60 that jitter needs are drawn

/// Motions of our own, and the recordings that are there.
std::vector<std::string> find_motions() {
  std::vector<std::string> motions{"builtin:wave", "builtin:open_close", "builtin:rotate",
                                   "builtin:pinch"};
  const char* data = std::getenv("HANDCAST_DATA");
  for (const char* name : {"deformation", "translation"}) {
    const auto recording = std::filesystem::path(data ? data : "../shared/data") / "lmc" / name;
    if (std::filesystem::exists(recording)) {
      motions.push_back(recording.string());
    } else {
      fmt::print("not measured: the recording {} is not here (set HANDCAST_DATA)\n",
                 recording.string());
    }
  }
  return motions;
}
const std::vector<std::string> kMotions = find_motions();

std::string short_name(const std::string& motion) {
  return motion.starts_with("builtin:") ? motion.substr(8)
                                        : std::filesystem::path(motion).filename().string();
}

const std::string kHighest(msg::kRungNames.back());

double number(const nlohmann::json& metrics, const char* place) {
  const nlohmann::json::json_pointer at(place);
  return metrics.contains(at) && metrics[at].is_number() ? metrics[at].get<double>() : std::nan("");
}

std::vector<SimulatedRun> ladder_runs() {
  std::vector<SimulatedRun> runs;
  for (const auto name : msg::kRungNames) {
    const std::string rung(name);
    for (const auto& motion : kMotions)
      for (const double speed : kSpeeds)
        runs.push_back({rung, motion, speed, {"cascade.ladder.rung=" + rung}, 24, {}});
    runs.push_back({rung, kStill, 1, {"cascade.ladder.rung=" + rung}, kForJitter, {}});
  }
  return runs;
}

/// The filters alone, against a tracker with a fixed bias and no drift and a detector with white
/// noise, as old as the paper's.
std::vector<SimulatedRun> filter_runs() {
  const std::vector<std::string> common{
      "cascade.ladder.rung=landmarks", "twin.tracker.drift_px=0", "landmarks.backend=twin",
      "twin.detector.noise_px=1",      "twin.detector.bias_px=0", "twin.detector.age_ms=16.2",
      "twin.detector.age_sd_ms=1.9"};
  std::vector<SimulatedRun> runs;
  auto paper = common;
  paper.insert(paper.end(), {"cascade.filter.method=paper", "cascade.filter.blend_ms=0"});
  for (const auto& motion : kMotions) {
    runs.push_back({"ours", motion, 1, common, 0, {}});
    runs.push_back({"paper", motion, 1, paper, 0, {}});
  }
  runs.push_back({"ours, still", kStill, 1, common, 0, {}});
  runs.push_back({"paper, still", kStill, 1, paper, 0, {}});
  return runs;
}

/// A detector that finds nothing for 0.3 s.
std::vector<SimulatedRun> lost_detector_runs() {
  std::vector<SimulatedRun> runs;
  for (const auto& motion : kMotions)
    runs.push_back(
        {"lost", motion, 1, {"twin.detector.lost_at_s=1.7", "twin.detector.lost_s=0.3"}, 0, {}});
  return runs;
}

using Runs = std::vector<SimulatedRun>;

/// Of the runs that `wanted` names, the mean of a figure.
double mean_of(const Runs& runs, const char* place,
               const std::function<bool(const SimulatedRun&)>& wanted) {
  double sum = 0;
  int count = 0;
  for (const auto& run : runs)
    if (wanted(run)) sum += number(run.metrics, place), ++count;
  return count > 0 ? sum / count : std::nan("");
}

const SimulatedRun& find(const Runs& runs, const std::string& label, const std::string& motion,
                         double speed) {
  return *std::ranges::find_if(runs, [&](const auto& run) {
    return run.label == label && run.motion == motion && run.speed == speed;
  });
}

/// Median frame times by rung.
std::map<std::string, double> frame_times_us() {
  constexpr int kFrames = 1000;
  std::vector<FrameScene> scenes;
  for (const auto name : msg::kRungNames) {
    const std::string rung(name);
    scenes.push_back({.name = rung});
    scenes.back().cascade.ladder.rung = *config::choice_named<config::RungChoice>(rung);
  }
  const std::vector<FrameTimes> times = time_frames(scenes, kFrames);
  std::map<std::string, double> medians;
  for (std::size_t i = 0; i < scenes.size(); ++i)
    medians[scenes[i].name] = times[i].error.empty() ? median(times[i].frame_us) : std::nan("");
  return medians;
}

void print_table(const Runs& runs, const std::map<std::string, double>& frame_us) {
  fmt::print(
      "interior error, mean/p95 mm, by motion x speed; jitter px of a still hand; render() on one "
      "core, p50 µs\n{:<11}",
      "rung");
  for (const auto& motion : kMotions)
    for (const double speed : kSpeeds)
      fmt::print(" {:>15}", fmt::format("{} x{:g}", short_name(motion), speed));
  fmt::print(" {:>15} {:>7} {:>7}\n", "still", "jitter", "µs");
  const auto spread = [](const SimulatedRun& run) {
    return fmt::format("{:.2f}/{:.2f}", number(run.metrics, "/interior_mm/mean"),
                       number(run.metrics, "/interior_mm/p95"));
  };
  for (const auto name : msg::kRungNames) {
    const std::string rung(name);
    fmt::print("{:<11}", rung);
    for (const auto& motion : kMotions)
      for (const double speed : kSpeeds)
        fmt::print(" {:>15}", spread(find(runs, rung, motion, speed)));
    const auto& still = find(runs, rung, kStill, 1);
    fmt::print(" {:>15} {:>7.3f} {:>7.0f}\n", spread(still), number(still.metrics, "/jitter_px"),
               frame_us.at(rung));
  }
}

void print_recovery(const Runs& lost) {
  fmt::print("\na detector lost for 0.3 s: good again after, ms (detections)\n");
  for (const auto& run : lost)
    fmt::print("{:<20} {:.0f} ({:.0f})\n", short_name(run.motion),
               number(run.metrics, "/fault/recovery_ms"),
               number(run.metrics, "/fault/recovery_detections"));
}

/// How much the highest rung errs more than the best one, on the worst motion.
double worst_against_best(const Runs& runs) {
  double worst = 0;
  for (const auto& chosen : runs) {
    if (chosen.label != kHighest) continue;
    double best = 1e9;
    for (const auto& run : runs)
      if (run.motion == chosen.motion && run.speed == chosen.speed)
        best = std::min(best, number(run.metrics, "/interior_mm/mean"));
    worst = std::max(worst, number(chosen.metrics, "/interior_mm/mean") / best);
  }
  return worst;
}

/// A figure of the speed bins named, weighed by their frames, over all runs of the highest rung but
/// the still one.
double in_bins(const Runs& runs, const char* figure, const std::vector<std::string>& bins) {
  double sum = 0, frames = 0;
  for (const auto& run : runs)
    for (const auto& bin : bins) {
      if (run.label != kHighest || run.motion == kStill || !run.metrics.contains("bins")) continue;
      const auto& at = run.metrics["bins"][bin];
      if (!at[figure].is_number()) continue;
      sum += at[figure].get<double>() * at["frames"].get<double>();
      frames += at["frames"].get<double>();
    }
  return frames > 0 ? sum / frames : std::nan("");
}

std::vector<Goal> goals_of(const Runs& runs, const Runs& filters, const Runs& lost,
                           std::map<std::string, double> frame_us) {
  const auto chosen = [&](double speed) {
    return [speed](const SimulatedRun& run) {
      return run.label == kHighest && run.speed == speed && run.motion != kStill;
    };
  };
  const auto of = [](const std::string& label) {
    return [label](const SimulatedRun& run) { return run.label == label; };
  };
  const std::vector<std::string> slow{"0-0.1", "0.1-0.3", "0.3-0.6"};
  return {
      {"interior error, natural speed, mean", mean_of(runs, "/interior_mm/mean", chosen(1)), 1.35,
       "mm"},
      {"interior error, natural speed, p95", mean_of(runs, "/interior_mm/p95", chosen(1)), 2.9,
       "mm"},
      {"interior error, 3x speed, mean", mean_of(runs, "/interior_mm/mean", chosen(3)), 2.4, "mm"},
      {"interior error, 3x speed, p95", mean_of(runs, "/interior_mm/p95", chosen(3)), 6.6, "mm"},
      {"filter, landmark error against the paper's",
       mean_of(filters, "/landmark_mm/mean", of("ours")) /
           mean_of(filters, "/landmark_mm/mean", of("paper")),
       0.7, "times"},
      {"filter, jitter of a still hand against the paper's",
       mean_of(filters, "/landmark_jitter_px", of("ours, still")) /
           mean_of(filters, "/landmark_jitter_px", of("paper, still")),
       0.25, "times"},
      {"coverage up to 0.6 m/s", in_bins(runs, "coverage", slow), 0.99, "", true},
      {"spill up to 0.6 m/s", in_bins(runs, "spill", slow), 0.01, ""},
      {"still-hand jitter", number(find(runs, kHighest, kStill, 1).metrics, "/jitter_px"), 0.5,
       "px"},
      {"fold-overs", mean_of(runs, "/foldovers", of(kHighest)), 0, ""},
      {"good again after a lost detector", mean_of(lost, "/fault/recovery_detections", of("lost")),
       2, "detections"},
      {"equivalent latency above 1 m/s", in_bins(runs, "equivalent_latency_ms", {">1.0"}), 6.62,
       "ms"},
      {"the highest rung against the best one, worst motion", worst_against_best(runs), 1.05,
       "times"},
      {"whole cascade with registration, one core, p50", frame_us[kHighest] / 1000, 1.5, "ms"},
  };
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  const bool with_goals = argc == 3 && std::strcmp(argv[1], "--goals") == 0;
  if (argc != 1 && !with_goals) {
    fmt::print(stderr, "usage: bench_cascade [--goals FILE]\n");
    return 2;
  }
  const auto frame_us = frame_times_us();
  auto runs = ladder_runs(), filters = filter_runs(), lost = lost_detector_runs();
  simulate_all(runs, kSeconds);
  simulate_all(filters, kSeconds);
  simulate_all(lost, kSeconds);
  print_table(runs, frame_us);
  print_recovery(lost);
  const auto goals = goals_of(runs, filters, lost, frame_us);
  print_goals(goals);
  if (!with_goals || write_goals(argv[2], goals)) return 0;
  fmt::print(stderr, "bench_cascade: cannot write '{}'.\n", argv[2]);
  return 1;
}
