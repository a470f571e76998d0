// SPDX-License-Identifier: Apache-2.0
// From kill -9 of a service to its successor's first message, as somebody outside sees it: the real
// supervisor, bare daemons.
//   bench_rings_restarts [--goals FILE] [--kills N]
#include <fmt/format.h>
#include <signal.h>

#include <cstdlib>
#include <string_view>
#include <vector>

#include "ipc/base/clock.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/rings_bare_rig.hpp"
#include "tests/bench/rings_process.hpp"
#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {
namespace {

constexpr auto kRestartPatience = std::chrono::seconds(10);
constexpr std::int64_t kLook_every_ns = 20'000;

/// Each from the kill.
struct Restarts {
  std::vector<double> program_ms;  ///< to the successor's main; below 0 where that was a standby
  std::vector<double> seen_ms;     ///< to its first message
};

void kill_one(const BareRig& rig, const std::string& service, Restarts& restarts) {
  const auto view = rig.view_of(rig.streams().at(service));
  const auto epoch = view.epoch();
  const auto victim = rig.pid_of(service);
  const auto limit = Deadline::in(kRestartPatience);
  const auto killed_ns = now_ns();
  ::kill(victim, SIGKILL);
  while (view.epoch() == epoch) {
    if (limit.passed()) give_up(service + " does not come back");
    sleep_until_ns(now_ns() + kLook_every_ns);
  }
  const auto seen_ns = now_ns();
  restarts.seen_ms.push_back(ns_to_ms(seen_ns - killed_ns));
  restarts.program_ms.push_back(ns_to_ms(view.look().newest_origin_ns - killed_ns));
}

/// Each service of a new rig once: the second death of one would be waited for by the restart
/// policy.
void kill_each(const BarePrograms& programs, bool standby, Restarts& restarts) {
  const BareRig rig(programs, standby);
  for (const auto& [service, stream] : rig.streams()) kill_one(rig, service, restarts);
}

void print(std::string_view name, const Restarts& restarts) {
  fmt::print(
      "{:<14} {:>5} kills   first message after {:.2f} ms p50, {:.2f} ms p99, {:.2f} ms at most   "
      "its main after {:.2f} ms p50\n",
      name, restarts.seen_ms.size(), median(restarts.seen_ms), percentile(restarts.seen_ms, 0.99),
      percentile(restarts.seen_ms, 1), median(restarts.program_ms));
}

std::vector<Goal> measure_goals(std::size_t kills) {
  become_real_time();
  const BarePrograms programs;
  Restarts bare, warm;
  while (bare.seen_ms.size() < kills) {
    kill_each(programs, false, bare);
    kill_each(programs, true, warm);
  }
  fmt::print("\nkill -9 of a bare daemon under `handcast up`\n");
  print("started anew", bare);
  print("warm standby", warm);
  return {
      {"kill -9 -> first new message p99, bare daemon", percentile(bare.seen_ms, 0.99), 3, "ms"},
      {"kill -9 -> first new message p50, warm standby", median(warm.seen_ms), 1, "ms"}};
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  std::string goals_file;
  std::size_t kills = 200;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    if (i + 1 < argc && name == "--goals")
      goals_file = argv[i + 1];
    else if (i + 1 < argc && name == "--kills")
      kills = std::strtoul(argv[i + 1], nullptr, 10);
    else
      give_up(fmt::format("{} is unknown, or has no value", name));
  }
  const auto goals = measure_goals(kills);
  if (!goals_file.empty() && !write_goals(goals_file, goals)) give_up("cannot write " + goals_file);
}
