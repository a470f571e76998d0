// What a landmark network costs in each back end on one core, all of them in turn in one run.
//   bench_landmarks [--goals FILE] [--rounds N] [NETWORK.onnx...]
// Without files: those of ../shared/models (HANDCAST_MODELS names another place).
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "goals.hpp"
#include "percentiles.hpp"
#include "services/landmarks/network/cost.hpp"
#include "services/landmarks/network/network.hpp"

namespace handcast::bench {
namespace {

using landmarks::Network;

struct Options {
  std::string goals_file;
  int rounds = 200;
  std::vector<std::filesystem::path> files;
};

/// Wall time is what a hand waits; the thread's own time is that on a core which nothing else uses.
struct Times {
  std::vector<double> wall_ms, own_ms;
};

struct Contender {
  std::string backend;
  std::unique_ptr<Network> network;
  Times times;
};

struct Measured {
  std::string name;
  double mmac = 0;
  std::map<std::string, Times> times;

  double own_ms(const std::string& backend) const {
    const auto found = times.find(backend);
    return found == times.end() ? 0 : median(found->second.own_ms);
  }
};

double own_time_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

void fill(std::span<float> numbers) {
  unsigned seed = 1;
  for (float& number : numbers) {
    seed = seed * 1664525u + 1013904223u;
    number = static_cast<float>(seed >> 8) / 16777216.f;
  }
}

std::vector<Contender> contenders_for(const std::filesystem::path& file) {
  std::vector<Contender> contenders;
  for (const auto& backend : landmarks::network_backends()) {
    auto network = backend.open(file);
    if (!network) {
      fmt::print("{} in {}: not measured: {}\n", file.filename().string(), backend.name, network.error().what);
      continue;
    }
    for (std::size_t i = 0; i < (*network)->inputs().size(); ++i) fill((*network)->input(i));
    contenders.push_back({backend.name, std::move(*network), {}});
  }
  return contenders;
}

Measured measure(const std::filesystem::path& file, int rounds) {
  Measured result{file.stem().string(), landmarks::network_mmac(file).value_or(0), {}};
  std::vector<Contender> contenders = contenders_for(file);
  for (int round = 0; round < rounds; ++round) {
    for (Contender& contender : contenders) {
      const double before = own_time_ms();
      bool sound = true;
      contender.times.wall_ms.push_back(timed_us([&] { sound = contender.network->run().has_value(); }) / 1000);
      contender.times.own_ms.push_back(own_time_ms() - before);
      if (!sound) fmt::print("{} in {}: a run failed\n", result.name, contender.backend);
    }
  }
  for (Contender& contender : contenders) result.times[contender.backend] = std::move(contender.times);
  return result;
}

void print(const Measured& result) {
  for (const auto& [backend, times] : result.times) {
    fmt::print("{:<22} {:<8} {:7.1f} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:8.1f}\n", result.name, backend, result.mmac,
               percentile(times.wall_ms, 0), median(times.wall_ms), percentile(times.wall_ms, 0.99), median(times.own_ms),
               percentile(times.own_ms, 0.99), result.mmac / median(times.own_ms));
  }
}

/// Judged by the thread's own time: on a machine with other work the wall's tells of that work.
std::vector<Goal> goals_of(const Measured& result) {
  static const std::map<std::string, double> kLimits_ms{{"hand_landmark_lite", 4}, {"palm_detection_lite", 6}, {"first_trial", 1}};
  std::vector<Goal> goals;
  const double ours = result.own_ms("onednn"), reference = result.own_ms("opencv");
  const auto limit = kLimits_ms.find(result.name);
  if (ours <= 0 || limit == kLimits_ms.end()) return goals;
  goals.push_back({result.name + " in onednn, one core, p50", ours, limit->second, "ms"});
  if (reference > 0 && result.name == "hand_landmark_lite")
    goals.push_back({result.name + ", opencv / onednn", reference / ours, 4, "times", true});
  return goals;
}

std::vector<std::filesystem::path> known_files() {
  const char* place = std::getenv("HANDCAST_MODELS");
  const std::filesystem::path folder = place ? place : "../shared/models";
  std::vector<std::filesystem::path> files;
  for (const char* name : {"hand_landmark_lite", "palm_detection_lite", "first_trial"}) {
    const std::filesystem::path file = folder / (std::string(name) + ".onnx");
    if (std::filesystem::exists(file))
      files.push_back(file);
    else
      fmt::print("{}: not measured: it is not in '{}' (HANDCAST_MODELS names another place)\n", name, folder.string());
  }
  return files;
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
  if (options.files.empty()) options.files = known_files();
  return options;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  const Options options = parse(argc, argv);
  std::vector<Goal> goals;
  fmt::print("{:<22} {:<8} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "one thread, ms", "", "MMAC", "min", "p50", "p99", "own p50",
             "own p99", "GMAC/s");
  for (const auto& file : options.files) {
    const auto result = measure(file, options.rounds);
    print(result);
    for (const Goal& goal : goals_of(result)) goals.push_back(goal);
  }
  print_goals(goals);
  if (!options.goals_file.empty() && !write_goals(options.goals_file, goals)) {
    fmt::print(stderr, "bench_landmarks: cannot write '{}'.\n", options.goals_file);
    return 1;
  }
  return 0;
}
