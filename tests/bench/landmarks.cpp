// SPDX-License-Identifier: Apache-2.0
// The time of each landmark network, ours and OpenCV's in turns, and of a whole estimate of each
// landmark model, on one core.
//   bench_landmarks [--goals FILE] [--rounds N] [NETWORK.onnx...]
// Without files: the network that comes with handcast, those of ../shared/models (HANDCAST_MODELS
// names another folder), and the whole estimates.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>

#include "services/landmarks/models/handcast_model.hpp"
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

/// Wall time, and the time of the thread, which other programs on the core do not add to.
struct Times {
  std::vector<double> wall_ms, thread_ms;
};

/// The median of each subject's thread time, by name and executor.
using Medians = std::map<std::pair<std::string, std::string>, double>;

double thread_time_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Empty for a subject whose multiplications are not counted.
std::string counted(double mmac, double value) {
  return mmac > 0 ? fmt::format("{:.1f}", value) : "";
}

void print(const Subject& subject, const Times& times) {
  fmt::print("{:<26} {:<8} {:>7} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:>8}\n", subject.name,
             subject.executor, counted(subject.mmac, subject.mmac), percentile(times.wall_ms, 0),
             median(times.wall_ms), percentile(times.wall_ms, 0.99), median(times.thread_ms),
             percentile(times.thread_ms, 0.99),
             counted(subject.mmac, subject.mmac / median(times.thread_ms)));
}

void measure(const std::vector<Subject>& subjects, int rounds, Medians& medians) {
  std::vector<Times> times(subjects.size());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      bool sound = subjects[i].run();  // fills the caches, as in a detector
      const double before = thread_time_ms();
      times[i].wall_ms.push_back(timed_us([&] { sound = subjects[i].run() && sound; }) / 1000);
      times[i].thread_ms.push_back(thread_time_ms() - before);
      if (!sound) fmt::print("{} in {}: a run failed\n", subjects[i].name, subjects[i].executor);
    }
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    print(subjects[i], times[i]);
    medians[{subjects[i].name, subjects[i].executor}] = median(times[i].thread_ms);
  }
}

/// Judged by thread time: on a machine with other work, wall time measures that work, too.
std::vector<Goal> goals_of(const Medians& medians) {
  struct Limit {
    std::string name, goal;
    double most_ms;
  };
  static const Limit kLimits[] = {
      {"handcast", "handcast's network in onednn, one core, p50", 1},
      {estimate_of("handcast"), "handcast's whole estimate, one core, p50", 1},
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
                 shipped = landmarks::shipped_network_file();
  for (const fs::path& file :
       {shipped, folder / "first_trial.onnx", folder / "hand_landmark_lite.onnx",
        folder / "palm_detection_lite.onnx"})
    if (is_there(file)) measure(network_subjects(file), rounds, medians);
  for (const auto& model : estimate_subjects(folder)) measure({model}, rounds, medians);
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
  fmt::print("{:<26} {:<8} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "one thread, ms", "",
             "MMAC", "min", "p50", "p99", "thr. p50", "thr. p99", "GMAC/s");
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
