// SPDX-License-Identifier: Apache-2.0
// How far the joints of pose.backend = "stereo" are from the true ones, per motion, with the real
// network on the twin's images of two cameras; beside them the twin's model of a tracker.
//   bench_trackers_stereo [RIG.toml] [--set PATH=VALUE]... [--tune] [--no-hints] [--seconds S]
//                         [--seed N] [--only leap|gige] [--motion NAME] [--anew S] [--goals FILE]
// The default rig is config/rigs/twin.toml. --tune: the motions and the seed that settings were
// chosen on. --no-hints: the network does not get what the poses predict.
// --anew: detectors and tracker forget all every S seconds, as after a cable was pulled; exchanged
// hands are those that are taken for the other one.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/stereo_trial.hpp"

namespace handcast::bench {
namespace {

struct Options {
  std::string rig = "config/rigs/twin.toml", goals, only, motion;
  std::vector<std::string> settings;
  bool tune = false;
  TrialPlan plan;
  int seed = 0;
};

std::vector<std::string> motions(const Options& options) {
  if (!options.motion.empty()) return {options.motion};
  std::vector<std::string> names;
  const std::vector<const char*> builtin =
      options.tune
          ? std::vector<const char*>{"wave", "open_close", "pinch", "fist", "two_hands", "reverse"}
          : std::vector<const char*>{"show",          "rotate",        "shake",
                                     "flip",          "cross_fingers", "point_at_camera",
                                     "turn_pointing", "turn_fist",     "crossing",
                                     "enter_leave"};
  for (const char* name : builtin) names.push_back(std::string("builtin:") + name);
  return names;
}

/// Recordings are where the reference rig's camera sees them, not the nearer one.
std::vector<std::string> recordings(const Options& options) {
  std::vector<std::string> names;
  if (options.tune || !options.motion.empty()) return names;
  const char* data = std::getenv("HANDCAST_DATA");
  const auto folder = std::filesystem::path(data ? data : "../shared/data") / "lmc";
  for (const char* name : {"translation", "rotation", "deformation", "all_5s"})
    if (std::filesystem::exists(folder / name)) names.push_back((folder / name).string());
  if (names.empty())
    fmt::print("no recordings in {}; HANDCAST_DATA names another folder\n", folder.string());
  return names;
}

void print_row(const std::string& name, const StereoTrial& trial) {
  const auto part = [](const std::vector<double>& mm) {
    return mm.empty() ? std::string("     -     -")
                      : fmt::format("{:6.1f}{:6.1f}", mean(mm), percentile(mm, 0.95));
  };
  const auto& [stereo, tracker, work_us, landmarks_mm] = trial;
  const auto longest_s = stereo.exchanges_s.empty() ? 0 : std::ranges::max(stereo.exchanges_s);
  fmt::print(
      "{:<17}{} |{} |{} |{:6.1f} |{:6.1f}{:4}{:6.2f} |{} |{} |{} |{:6.1f} |{} |{:6.1f}{:6.1f}\n",
      name, part(stereo.all_mm), part(stereo.open_mm), part(stereo.folded_tips_mm),
      100.0 * stereo.missing / std::max(stereo.hands, 1),
      100.0 * stereo.exchanged / std::max(stereo.poses, 1), stereo.exchanges_s.size(), longest_s,
      part(stereo.later_mm), part(landmarks_mm), part(tracker.all_mm),
      100.0 * tracker.missing / std::max(tracker.hands, 1), part(tracker.later_mm),
      percentile(work_us, 0.5) / 1000, percentile(work_us, 0.99) / 1000);
  std::fflush(stdout);
}

Result<StereoTrial> run_rig(const StereoRig& stereo, const Options& options,
                            const config::Rig& rig) {
  fmt::print(
      "\n{}\n{:<17}{:>12} |{:>12} |{:>12} |{:>6} |{:>16} |{:>12} |{:>12} |{:>12} |{:>6} |{:>12} "
      "|{:>12}\n",
      stereo.name, "mean, p95 in mm", "all joints", "open hands", "folded tips", "lost %",
      "exchanged %, n, s", "16 ms later", "landmarks", "twin tracker", "lost %", "16 ms later",
      "ms p50 p99");
  auto names = motions(options);
  if (stereo.name == "gige")
    for (auto& name : recordings(options)) names.push_back(std::move(name));
  StereoTrial all;
  for (const auto& name : names) {
    auto moved = rig;
    moved.twin.motion = name;
    const auto trial = run_trial(stereo, moved, options.plan);
    if (!trial) return tl::make_unexpected(trial.error());
    print_row(name.substr(name.find_last_of(":/") + 1), *trial);
    all.stereo.add(trial->stereo);
    all.tracker.add(trial->tracker);
    all.work_us.insert(all.work_us.end(), trial->work_us.begin(), trial->work_us.end());
    all.landmarks_mm.insert(all.landmarks_mm.end(), trial->landmarks_mm.begin(),
                            trial->landmarks_mm.end());
  }
  print_row("all", all);
  return all;
}

void add_goals(const std::string& name, const StereoTrial& all, std::vector<Goal>& goals) {
  const auto& errors = all.stereo;
  goals.push_back({name + ": joints of open hands, mean", mean(errors.open_mm), 4, "mm"});
  goals.push_back(
      {name + ": joints of open hands, p95", percentile(errors.open_mm, 0.95), 9, "mm"});
  goals.push_back({name + ": tips of folded fingers, mean", mean(errors.folded_tips_mm), 12, "mm"});
  goals.push_back({name + ": a sample beside the networks, p99",
                   percentile(all.work_us, 0.99) / 1000, 5, "ms"});
}

int run(const Options& options) {
  auto rig = config::load_rig(options.rig, options.settings);
  if (!rig) {
    fmt::print(stderr, "{}\n", rig.error().what);
    return 1;
  }
  rig->twin.seed = options.seed > 0 ? options.seed : options.tune ? 1 : 11;
  std::vector<Goal> goals;
  for (const auto& stereo : {leap_rig(), gige_rig()}) {
    if (!options.only.empty() && options.only != stereo.name) continue;
    const auto all = run_rig(stereo, options, *rig);
    if (!all) {
      fmt::print(stderr, "{}\n", all.error().what);
      return 1;
    }
    add_goals(stereo.name, *all, goals);
  }
  print_goals(goals);
  return options.goals.empty() || write_goals(options.goals, goals) ? 0 : 1;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  handcast::bench::Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_next = i + 1 < argc;
    if (word == "--tune") {
      options.tune = true;
    } else if (word == "--no-hints") {
      options.plan.hints = false;
    } else if (word == "--set" && has_next) {
      options.settings.emplace_back(argv[++i]);
    } else if (word == "--seconds" && has_next) {
      options.plan.seconds = std::atof(argv[++i]);
    } else if (word == "--anew" && has_next) {
      options.plan.anew_s = std::atof(argv[++i]);
    } else if (word == "--seed" && has_next) {
      options.seed = std::atoi(argv[++i]);
    } else if (word == "--only" && has_next) {
      options.only = argv[++i];
    } else if (word == "--motion" && has_next) {
      options.motion = argv[++i];
    } else if (word == "--goals" && has_next) {
      options.goals = argv[++i];
    } else {
      options.rig = word;
    }
  }
  return handcast::bench::run(options);
}
