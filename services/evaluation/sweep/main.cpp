// SPDX-License-Identifier: Apache-2.0
// handcast sweep: grids of settings over motions, seeds and speeds, on all cores.
#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <exception>

#include "ipc/base/version.hpp"
#include "ipc/daemon/exit_code.hpp"
#include "services/evaluation/sweep/merge.hpp"
#include "services/evaluation/sweep/runner.hpp"

namespace handcast::sweep {
namespace {

struct CommandLine {
  std::vector<std::string> files;
  std::string output, shard;
  int jobs = 0;
  bool fresh = false, list = false, merge = false, quiet = false;
};

constexpr int kExitStopped = 130;  ///< as a shell names the end of a program by Ctrl-C

const char* const kFooter = R"(A plan is a TOML file, every path in it relative to the file:
  rig = "../rigs/twin.toml"    seconds = 5    warm_up_s = 0.5    draw_every = 24    joints_only = false
  [settings]    of every run, e.g. twin.tracker.age_ms = 15
  [[variant]]   name, its own rig and settings, e.g. settings.cascade.filter.method = "one_euro"
  [grid]        every combination, e.g. twin.speed = [1, 2, 3]; several, each a [[grid]], are run one after the other
Settings are those of config/REFERENCE.md; config/sweeps holds plans.

The same command goes on where a sweep was cut off, and tries again what failed. On many machines: one `--shard I/N` each, then --merge.
Times of frames and stages are those of a core among busy ones; to measure them take -j 1.
Exit code 1: runs failed, or are missing from what was merged. 130: stopped before the end.)";

std::atomic<bool> stop{false};

/// The first Ctrl-C lets the runs that are under way end; the second ends the program.
void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop = true; };
  action.sa_flags = SA_RESETHAND;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int complain(const Error& error) {
  fmt::print(stderr, "handcast sweep: {}\n", error.what);
  return exit_code_of(error);
}

std::filesystem::path output_of(const CommandLine& line, const Plan& plan, const Shard& shard) {
  if (!line.output.empty()) return line.output;
  const auto part = shard.count > 1 ? fmt::format(".{}-of-{}", shard.index, shard.count) : "";
  return std::filesystem::path("out") / fmt::format("{}{}.csv", plan.name, part);
}

int list_runs(const Plan& plan, const std::vector<Run>& runs, const Shard& shard) {
  for (const auto& run : runs) {
    if (!shard.has(run)) continue;
    const auto rig = rig_of(plan, run);
    const auto absent = rig ? why_absent(*rig) : std::nullopt;
    fmt::print("{:6}  {}{}\n", run.index, describe_run(plan, run),
               absent ? fmt::format("  [left out: {}]", *absent) : "");
  }
  return kExitDone;
}

int report(const Plan& plan, const Outcome& outcome, const std::filesystem::path& file) {
  fmt::print(
      "sweep {}: {} runs scored, {} failed, {} kept from before, {} left out, {} not begun: {}\n",
      plan.name, outcome.scored, outcome.failed, outcome.kept, outcome.absent, outcome.left,
      file.string());
  if (outcome.left > 0) return kExitStopped;
  return outcome.failed > 0 ? kExitBadResult : kExitDone;
}

int sweep(const CommandLine& line) {
  const auto shard = line.shard.empty() ? Result<Shard>(Shard{}) : parse_shard(line.shard);
  if (!shard) return complain(shard.error());
  const auto plan = load_plan(line.files.front());
  if (!plan) return complain(plan.error());
  const auto expansion = expand(*plan);
  if (!expansion) return complain(expansion.error());
  if (line.list) return list_runs(*plan, expansion->runs, *shard);

  const auto file = output_of(line, *plan, *shard);
  auto results =
      Results::open(file, heading_of(*plan, *expansion, std::string(version())), line.fresh);
  if (!results) return complain(results.error());
  stop_on_signals();
  const auto outcome =
      run_all(*plan, expansion->runs, {*shard, line.jobs, line.quiet}, **results, stop);
  return outcome ? report(*plan, *outcome, file) : complain(outcome.error());
}

int merge_files(const CommandLine& line) {
  if (line.output.empty())
    return complain({Errc::bad_config, "--merge: into which file? give it with -o"});
  const auto merged = merge({line.files.begin(), line.files.end()}, line.output);
  if (!merged) return complain(merged.error());
  fmt::print("{} runs, {} of them failed: {}\n", merged->rows, merged->failed, line.output);
  if (!merged->missing.empty())
    fmt::print(stderr, "handcast sweep: no file has runs {}\n", print_indices(merged->missing));
  return merged->missing.empty() && merged->failed == 0 ? kExitDone : kExitBadResult;
}

}  // namespace
}  // namespace handcast::sweep

int main(int argc, char** argv) try {
  using namespace handcast::sweep;
  CommandLine line;
  CLI::App app(
      "Scores a rig under every combination of the settings a plan names, in virtual time, to CSV.",
      "handcast sweep");
  app.footer(kFooter);
  app.add_option("PLAN.toml", line.files, "The plan; with --merge, the files of results")
      ->required();
  app.add_option("-o,--output", line.output, "The file of results (default: out/PLAN.csv)");
  app.add_option("--shard", line.shard, "I/N: only the runs whose index is I modulo N");
  app.add_option("-j,--jobs", line.jobs, "Runs at the same time (default: one per core)")
      ->check(CLI::Range(1, 4096));
  app.add_flag("--list", line.list, "Names the runs and runs none");
  app.add_flag("--fresh", line.fresh, "Forgets what the file of results holds");
  app.add_flag("--merge", line.merge, "Puts the results of shards together");
  app.add_flag("--quiet", line.quiet, "No progress line");
  app.set_version_flag("--version", fmt::format("handcast sweep {}", handcast::version()));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    return app.exit(problem) == 0 ? handcast::kExitDone : handcast::kExitUsage;
  }
  if (line.merge) return merge_files(line);
  if (line.files.size() > 1)
    return complain(
        {handcast::Errc::bad_config, "one plan, please; for files of results say --merge"});
  return sweep(line);
} catch (const std::exception& problem) {
  std::fprintf(stderr, "handcast sweep: %s\n", problem.what());
  return handcast::kExitRetry;
}
