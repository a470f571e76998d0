// SPDX-License-Identifier: Apache-2.0
// How long the stream of a service pauses when the service dies, hangs or is changed: a whole rig
// (config/rigs/twin.toml), as a reader of the stream sees it.
//   bench_control [--goals FILE] [--runs N]
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/clock.hpp"
#include "tests/bench/control_gap.hpp"
#include "tests/bench/control_rig.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {
namespace {

using control::Verb;

/// The default rates of projector and camera.
constexpr double kProjectorPeriod_ms = 1000.0 / 946, kCameraPeriod_ms = 1000.0 / 525;
/// Added to a period: the goal of a planned change.
constexpr double kChange_ms = 5;
/// The watch goes on for this time after the change, which may disturb the new process.
constexpr int kAfter_us = 150'000;

const std::vector<std::string> kStandby{"projector.process.standby=true"};

/// One row of the table.
struct Gaps {
  std::string name;
  double limit_ms = 0;               ///< of the pause; 0: no goal
  std::vector<double> pause_ms{};    ///< from the last message of the old process to the next one's
  std::vector<double> longest_ms{};  ///< from before the change until after it

  void add(const GapWatch& watch) {
    pause_ms.push_back(watch.pause_ms());
    longest_ms.push_back(watch.longest_ms());
  }
};

/// The gaps of a stream while `change` is made and until another writer publishes.
void measure(const TwinRig& rig, const std::string& stream, const std::function<void()>& change,
             Gaps& gaps) {
  const GapWatch watch(rig.view_of(stream));
  ::usleep(50'000);
  const auto epoch = watch.epoch();
  change();
  const auto limit = Deadline::in(std::chrono::seconds(30));
  while (watch.epoch() == epoch) {
    if (limit.passed()) give_up(stream + " does not go on");
    ::usleep(1'000);
  }
  ::usleep(kAfter_us);
  gaps.add(watch);
}

/// The gaps while nothing happens: what the load of the machine adds.
void measure_calm(const TwinRig& rig, const std::string& stream, Gaps& gaps) {
  const GapWatch watch(rig.view_of(stream));
  ::usleep(300'000);
  gaps.add(watch);
}

void measure_signal(const RigFolder& folder, bool standby, int signal, Gaps& gaps) {
  const TwinRig rig(folder, standby ? kStandby : std::vector<std::string>{});
  if (standby) rig.settle("projector");
  const auto pid = rig.pid_of("projector");
  measure(
      rig, "projection.frames", [&] { ::kill(pid, signal); }, gaps);
}

class Table {
 public:
  explicit Table(RigFolder& folder) : folder_(folder) {}

  /// Each death in a new rig: the restart policy makes the second one wait.
  void measure_deaths() {
    measure_signal(folder_, false, SIGKILL, crash_);
    measure_signal(folder_, true, SIGKILL, crash_standby_);
    measure_signal(folder_, false, SIGSTOP, stopped_);
  }
  void measure_changes(const TwinRig& rig) {
    measure_calm(rig, "projection.frames", calm_);
    change(rig, restart_, {.verb = Verb::restart, .service = "projector", .backend = {}});
    change(rig, swap_, {.verb = Verb::swap, .service = "projector", .backend = "file"});
    change(rig, swap_back_, {.verb = Verb::swap, .service = "projector", .backend = "twin"});
    change(rig, camera_, {.verb = Verb::swap, .service = "camera", .backend = "replay"});
    change(rig, camera_back_, {.verb = Verb::swap, .service = "camera", .backend = "twin"});
    folder_.change_a_projector_setting();
    change(rig, reload_, {.verb = Verb::reload, .service = {}, .backend = {}});
  }
  void measure_changes_with_standby(const TwinRig& rig) {
    rig.settle("projector");
    change(rig, restart_standby_, {.verb = Verb::restart, .service = "projector", .backend = {}});
  }
  void print() const {
    fmt::print("{:<32} {:>4} {:>17} {:>26}\n", "gaps in the stream, ms", "runs",
               "change: p50   max", "whole time: p50   max");
    for (const auto* row : rows())
      fmt::print("{:<32} {:>4} {:>11.1f} {:>5.1f} {:>20.1f} {:>5.1f}\n", row->name,
                 row->longest_ms.size(), median(row->pause_ms), percentile(row->pause_ms, 1),
                 median(row->longest_ms), percentile(row->longest_ms, 1));
  }
  std::vector<Goal> goals() const {
    std::vector<Goal> goals;
    for (const auto* row : rows())
      if (row->limit_ms > 0)
        goals.push_back({"gap p50, " + row->name, median(row->pause_ms), row->limit_ms, "ms"});
    return goals;
  }

 private:
  void change(const TwinRig& rig, Gaps& gaps, const control::Request& request) {
    const bool of_camera = request.service == "camera";
    const auto* stream = of_camera ? "camera.frames" : "projection.frames";
    measure(
        rig, stream, [&] { rig.ask(request); }, gaps);
    rig.settle("");
  }
  std::vector<const Gaps*> rows() const {
    return {&calm_,      &crash_,  &crash_standby_, &restart_, &restart_standby_, &swap_,
            &swap_back_, &camera_, &camera_back_,   &reload_,  &stopped_};
  }

  static constexpr double kProjector_ms = kProjectorPeriod_ms + kChange_ms,
                          kCamera_ms = kCameraPeriod_ms + kChange_ms;
  RigFolder& folder_;
  Gaps calm_{"nothing happens, projector"};
  Gaps crash_{"crash of the projector", 150}, crash_standby_{"crash of the projector, standby"};
  Gaps restart_{"restart projector", kProjector_ms},
      restart_standby_{"restart projector, standby", kProjector_ms};
  Gaps swap_{"swap projector twin -> file", kProjector_ms},
      swap_back_{"swap projector file -> twin", kProjector_ms};
  Gaps camera_{"swap camera twin -> replay", kCamera_ms},
      camera_back_{"swap camera replay -> twin", kCamera_ms};
  Gaps reload_{"reload, a projector setting", kProjector_ms};
  Gaps stopped_{"SIGSTOP of the projector", 1200};
};

std::vector<Goal> measure_goals(int runs) {
  RigFolder folder;
  Table table(folder);
  for (int run = 0; run < runs; ++run) table.measure_deaths();
  {
    const TwinRig rig(folder, {});
    for (int run = 0; run < runs; ++run) table.measure_changes(rig);
  }
  const TwinRig rig(folder, kStandby);
  for (int run = 0; run < runs; ++run) table.measure_changes_with_standby(rig);
  table.print();
  return table.goals();
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  std::string goals_file;
  int runs = 10;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    if (i + 1 < argc && name == "--goals")
      goals_file = argv[i + 1];
    else if (i + 1 < argc && name == "--runs")
      runs = std::max(1, std::atoi(argv[i + 1]));
    else
      give_up(fmt::format("{} is unknown, or has no value", name));
  }
  const auto goals = measure_goals(runs);
  print_goals(goals);
  if (!goals_file.empty() && !write_goals(goals_file, goals)) give_up("cannot write " + goals_file);
}
