// SPDX-License-Identifier: Apache-2.0
// handcast sweep: scores grids of settings over motions, seeds and speeds, on all cores.
#include <fmt/format.h>
#include <signal.h>

#include <atomic>
#include <cstdio>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/version.hpp"
#include "services/lab/sweep/columns.hpp"
#include "services/lab/sweep/results.hpp"
#include "services/lab/sweep/runner.hpp"

namespace handcast::sweep {
namespace {

struct Options {
  std::vector<std::string> files;
  std::string output, shard, record;
  int jobs = 0;
  bool fresh = false, list = false, merge = false, quiet = false;
};

constexpr int kExitStopped = 130;  ///< as a shell names the end of a program by Ctrl-C

const char* const kFooter = R"(A plan is a TOML file. The paths in it are relative to the file.
  rig = "../rigs/twin.toml"    seconds = 5    warm_up_s = 0.5    draw_every = 24 (or draw_hz = 30)    joints_only = false
  [settings]    settings of all runs, e.g. twin.tracker.age_ms = 15; settings_from = "FILE.toml": a file of such settings
  [[variant]]   a name with its own rig and settings, e.g. settings.cascade.filter.method = "paper"; with from = ["NAME"], it has
                the settings of variants above, too, and the rig of the first; with landmarks = "DIR" or poses = "DIR", the results
                of another method, a file for each case: DIR/000.csv or .npy and so on
  [grid]        lists of values, e.g. twin.speed = [1, 2, 3]; all combinations are run. Several [[grid]] are run one after the other
config/REFERENCE.md lists the settings; config/sweeps holds plans.

The same command continues an interrupted sweep and repeats the runs that failed, unless the program was built again meanwhile. To
use several machines, run one `--shard I/N` on each and --merge the results. The measured times of frames and stages depend on the number of jobs; use -j 1 to compare them.
Exit codes: 1 if runs failed, all were left out, or some are missing after a merge, 130 if the sweep was interrupted.)";

std::atomic<bool> stop{false};

/// Installs the handler: the first Ctrl-C lets the current runs end, the second ends the program.
void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop = true; };
  action.sa_flags = SA_RESETHAND;
  for (const int number : {SIGINT, SIGTERM})
    if (!handcast::inherited::is_ignored(number)) sigaction(number, &action, nullptr);
}

int complain(const Error& error) {
  fmt::print(stderr, "handcast sweep: {}\n", printable(error.what));
  return exit_code_of(error);
}

std::filesystem::path output_of(const Options& options, const Plan& plan, const Shard& shard) {
  if (!options.output.empty()) return options.output;
  const auto part = shard.count > 1 ? fmt::format(".{}-of-{}", shard.index, shard.count) : "";
  return std::filesystem::path("out") / fmt::format("{}{}.csv", plan.name, part);
}

int list_runs(const Plan& plan, const std::vector<Run>& runs, const Shard& shard) {
  for (const auto& run : runs) {
    if (!shard.has(run)) continue;
    const auto rig = rig_of(plan, run);
    const auto absent = rig ? why_absent(plan, run, *rig) : std::nullopt;
    fmt::print("{:6}  {}{}\n", run.index, describe_run(plan, run),
               absent ? fmt::format("  [left out: {}]", *absent) : "");
  }
  return kExitDone;
}

int report(const Plan& plan, const Outcome& outcome, const std::filesystem::path& file) {
  fmt::print("sweep {}: {} runs scored, {} failed, {} kept, {} left out, {} not begun: {}\n",
             plan.name, outcome.scored, outcome.failed, outcome.kept, outcome.absent, outcome.left,
             file.string());
  if (outcome.left > 0) return kExitStopped;
  if (outcome.absent > 0 && outcome.scored + outcome.failed + outcome.kept == 0) {
    fmt::print(stderr, "handcast sweep: all runs were left out: nothing was measured\n");
    return kExitBadResult;
  }
  return outcome.failed > 0 ? kExitBadResult : kExitDone;
}

int sweep(const Options& options) {
  const auto shard = options.shard.empty() ? Result<Shard>(Shard{}) : parse_shard(options.shard);
  if (!shard) return complain(shard.error());
  const auto plan = load_plan(options.files.front());
  if (!plan) return complain(plan.error());
  const auto expansion = expand(*plan);
  if (!expansion) return complain(expansion.error());
  if (options.list) return list_runs(*plan, expansion->runs, *shard);
  if (!options.record.empty() && plan->variants.size() > 1)
    return complain({Errc::bad_config, "--record: the plan has several variants"});

  const auto file = output_of(options, *plan, *shard);
  auto results =
      Results::open(file, heading_of(*plan, *expansion, std::string(version())), options.fresh);
  if (!results) return complain(results.error());
  stop_on_signals();
  const auto outcome =
      run_all(*plan, expansion->runs, {*shard, options.jobs, options.quiet, options.record},
              **results, stop);
  return outcome ? report(*plan, *outcome, file) : complain(outcome.error());
}

int merge_files(const Options& options) {
  if (options.output.empty())
    return complain({Errc::bad_config, "--merge needs an output file; give it with -o"});
  const auto merged = merge({options.files.begin(), options.files.end()}, options.output);
  if (!merged) return complain(merged.error());
  fmt::print("{} runs, {} of them failed: {}\n", merged->rows, merged->failed, options.output);
  if (!merged->missing.empty())
    fmt::print(stderr, "handcast sweep: no file has runs {}\n", print_indices(merged->missing));
  return merged->missing.empty() && merged->failed == 0 ? kExitDone : kExitBadResult;
}

}  // namespace
}  // namespace handcast::sweep

static int run_verb(int argc, char** argv) {
  using namespace handcast::sweep;
  Options options;
  handcast::CommandLine line(
      "handcast sweep",
      "Scores a rig in virtual time with all combinations of the settings of a plan, and writes a "
      "CSV file.",
      kFooter);
  line.add("PLAN.toml...", options.files, "The plan; with --merge, the files of results");
  line.add("-o, --output FILE", options.output, "File of results; default: out/PLAN.csv");
  line.add("--shard I/N", options.shard, "Does only the runs whose index is I modulo N");
  line.add("-j, --jobs N", options.jobs, "Number of simultaneous runs; default: one per core",
           {1, 4096});
  line.add("--list", options.list, "Prints the runs and does none");
  line.add("--fresh", options.fresh, "Discards the content of the file of results");
  line.add("--merge", options.merge, "Merges the results of shards into one file");
  line.add("--record DIR", options.record,
           "Draws nothing, and writes the images, messages and true hands of each case to "
           "DIR/000 and so on, as simulate --record does; for a plan of one variant");
  line.add("--quiet", options.quiet, "Prints no progress");
  if (const auto code = line.answered(argc, argv)) return *code;
  if (options.merge) return merge_files(options);
  if (options.files.size() > 1)
    return complain(
        {handcast::Errc::bad_config, "there must be one plan; use --merge for files of results"});
  return sweep(options);
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast sweep", argc, argv, run_verb);
}
