// SPDX-License-Identifier: Apache-2.0
// What a landmark network costs in each back end on one core, and a whole look at a hand: those of
// a kind in turn, in one run.
//   bench_landmarks [--goals FILE] [--rounds N] [NETWORK.onnx...]
// Without files: the network that comes with handcast, those of ../shared/models (HANDCAST_MODELS
// names another place), and whole looks.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>

#include "services/landmarks/finder/own_network.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/landmarks_subjects.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string goals_file;
  int rounds = 200;
  std::vector<fs::path> files;
};

/// Wall time is what a hand waits; the thread's own time is that on a core which nothing else uses.
struct Times {
  std::vector<double> wall_ms, own_ms;
};

/// The median of each subject's own time, by its name and back end.
using Medians = std::map<std::pair<std::string, std::string>, double>;

double own_time_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

void print(const Subject& subject, const Times& times) {
  fmt::print("{:<22} {:<8} {:7.1f} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:8.1f}\n", subject.name,
             subject.backend, subject.mmac, percentile(times.wall_ms, 0), median(times.wall_ms),
             percentile(times.wall_ms, 0.99), median(times.own_ms), percentile(times.own_ms, 0.99),
             subject.mmac / median(times.own_ms));
}

void measure(const std::vector<Subject>& subjects, int rounds, Medians& medians) {
  std::vector<Times> times(subjects.size());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      bool sound = subjects[i].run();  // back to back, as in a detector: the caches hold its own
      const double before = own_time_ms();
      times[i].wall_ms.push_back(timed_us([&] { sound = subjects[i].run() && sound; }) / 1000);
      times[i].own_ms.push_back(own_time_ms() - before);
      if (!sound) fmt::print("{} in {}: a run failed\n", subjects[i].name, subjects[i].backend);
    }
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    print(subjects[i], times[i]);
    medians[{subjects[i].name, subjects[i].backend}] = median(times[i].own_ms);
  }
}

/// Judged by the thread's own time: on a machine with other work the wall's tells of that work.
std::vector<Goal> goals_of(const Medians& medians) {
  struct Limit {
    const char *name, *goal;
    double most_ms;
  };
  static const Limit kLimits[] = {
      {"handcast", "our own network in onednn, one core, p50", 1},
      {kOwnLook, "our own network's whole look, one core, p50", 1},
      {"hand_landmark_lite", "hand_landmark_lite in onednn, one core, p50", 4},
      {"palm_detection_lite", "palm_detection_lite in onednn, one core, p50", 6}};
  std::vector<Goal> goals;
  for (const Limit& limit : kLimits)
    if (const auto found = medians.find({limit.name, "onednn"}); found != medians.end())
      goals.push_back({limit.goal, found->second, limit.most_ms, "ms"});
  const auto ours = medians.find({"hand_landmark_lite", "onednn"}),
             reference = medians.find({"hand_landmark_lite", "opencv"});
  if (ours != medians.end() && reference != medians.end())
    goals.push_back({"hand_landmark_lite, opencv / onednn", reference->second / ours->second, 4,
                     "times", true});
  return goals;
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  if (fs::exists(file, ignored)) return true;
  fmt::print("{}: not measured: there is no '{}'\n", file.stem().string(), file.string());
  return false;
}

void measure_known(int rounds, Medians& medians) {
  const char* place = std::getenv("HANDCAST_MODELS");
  const fs::path folder = place && *place ? place : "../shared/models",
                 own = landmarks::own::default_network_file();
  for (const fs::path& file : {own, folder / "first_trial.onnx", folder / "hand_landmark_lite.onnx",
                               folder / "palm_detection_lite.onnx"})
    if (is_there(file)) measure(network_subjects(file), rounds, medians);
  measure(own_looks(own), rounds, medians);
  measure(mediapipe_looks(folder), rounds, medians);
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--goals") == 0 && i + 1 < argc)
      options.goals_file = argv[++i];
    else if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc)
      options.rounds = std::max(std::atoi(argv[++i]), 1);
    else
      options.files.emplace_back(argv[i]);
  }
  return options;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  const Options options = parse(argc, argv);
  fmt::print("{:<22} {:<8} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "one thread, ms", "",
             "MMAC", "min", "p50", "p99", "own p50", "own p99", "GMAC/s");
  Medians medians;
  for (const auto& file : options.files) measure(network_subjects(file), options.rounds, medians);
  if (options.files.empty()) measure_known(options.rounds, medians);
  const std::vector<Goal> goals = goals_of(medians);
  print_goals(goals);
  if (!options.goals_file.empty() && !write_goals(options.goals_file, goals)) {
    fmt::print(stderr, "bench_landmarks: cannot write '{}'.\n", options.goals_file);
    return 1;
  }
  return 0;
}
