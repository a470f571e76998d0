// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "services/lab/simulate/score.hpp"
#include "services/lab/sweep/columns.hpp"
#include "services/lab/sweep/merge.hpp"
#include "services/lab/sweep/progress.hpp"

namespace handcast::sweep {
namespace {

simulate::Options options_of(const Plan& plan) {
  simulate::Options options;
  options.seconds = plan.seconds;
  options.warm_up_s = plan.warm_up_s;
  options.draw_every = plan.draw_every;
  return options;
}

Result<nlohmann::json> score(const Plan& plan, const Run& run) try {
  const auto rig = rig_of(plan, run);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto calibration = calib::load_calibration(rig->calibration, rig->projector.packing);
  if (!calibration) return tl::make_unexpected(calibration.error());
  const auto options = options_of(plan);
  auto metrics = simulate::score(*rig, *calibration, options);
  if (!metrics) return metrics;
  if (auto why = simulate::why_nothing_was_scored(*metrics, options); !why.empty())
    return fail(Errc::bad_config, std::move(why));
  return metrics;
} catch (const std::exception& problem) {
  return fail(Errc::unavailable, problem.what());
}

/// True if the run was scored, but no light was on a hand: a fault of the whole run, or a mistake
/// in its settings.
bool is_dark(const nlohmann::json& metrics) {
  return metrics.contains("coverage") && metrics["coverage"] == 0;
}

/// The runs of the shard that must be done. Prints those whose motion or hand is absent, a line for
/// each.
std::vector<const Run*> to_do(const Plan& plan, const std::vector<Run>& runs, const Work& work,
                              const Results& results, Outcome& outcome) {
  std::vector<const Run*> todo;
  std::map<std::string, std::vector<std::size_t>> absent;
  for (const auto& run : runs) {
    if (!work.shard.has(run)) continue;
    if (results.done().contains(run.index)) {
      ++outcome.kept;
      continue;
    }
    const auto rig = rig_of(plan, run);
    if (const auto why = rig ? why_absent(*rig) : std::nullopt) {
      absent[*why].push_back(run.index);
      ++outcome.absent;
    } else {
      todo.push_back(&run);
    }
  }
  for (const auto& [why, indices] : absent)
    fmt::print(stderr, "sweep {}: {}; left out: runs {}\n", plan.name, why, print_indices(indices));
  return todo;
}

/// Threads that do runs until none is left.
class Workers {
 public:
  Workers(const Plan& plan, const std::vector<const Run*>& todo, Results& results,
          const std::atomic<bool>& stop, bool quiet)
      : plan_(plan),
        todo_(todo),
        results_(results),
        stop_(stop),
        progress_(plan.name, todo.size(), quiet) {}

  Result<void> run(int jobs, Outcome& outcome) {
    {
      std::vector<std::jthread> threads;
      threads.reserve(static_cast<std::size_t>(jobs));
      for (int i = 0; i < jobs; ++i) threads.emplace_back([this] { work(); });
    }
    outcome.failed = failed_;
    outcome.scored = done_ - failed_;
    outcome.left = todo_.size() - done_;
    return broken_;
  }

 private:
  void work() {
    while (!stop_ && !full_) {
      const auto next = next_++;
      if (next >= todo_.size()) return;
      one(*todo_[next]);
    }
  }

  void one(const Run& run) {
    const auto json = score(plan_, run);
    const auto say = [&](std::string_view what) {
      progress_.say(fmt::format("sweep {}: run {} ({}): {}", plan_.name, run.index,
                                describe_run(plan_, run), what));
    };
    if (!json) say(json.error().what);
    if (json && is_dark(*json)) say("scored, but no light was on a hand in any frame");
    const auto written = results_.append(json ? scored_row(plan_, run, *json)
                                              : failed_row(plan_, run, json.error().what));
    if (!written) {
      if (!full_.exchange(true)) broken_ = written;
      return;
    }
    ++done_;
    failed_ += !json;
    progress_.one_done(!json);
  }

  const Plan& plan_;
  const std::vector<const Run*>& todo_;
  Results& results_;
  const std::atomic<bool>& stop_;
  Progress progress_;
  std::atomic<std::size_t> next_ = 0, done_ = 0, failed_ = 0;
  std::atomic<bool> full_ = false;
  Result<void> broken_;  ///< written by the thread that sets full_, read after all threads ended
};

}  // namespace

Result<Outcome> run_all(const Plan& plan, const std::vector<Run>& runs, const Work& work,
                        Results& results, const std::atomic<bool>& stop) {
  Outcome outcome;
  const auto todo = to_do(plan, runs, work, results, outcome);
  if (!todo.empty() && results.is_of_an_earlier_build())
    return fail(Errc::bad_config,
                fmt::format("sweep {}: the runs that are done are of an earlier build of this "
                            "program, whose figures may differ, and {} are left; give another file "
                            "with -o, or do all of them again with --fresh",
                            plan.name, todo.size()));
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int jobs =
      std::min(work.jobs > 0 ? work.jobs : cores, std::max(1, static_cast<int>(todo.size())));
  const auto worked = Workers(plan, todo, results, stop, work.quiet).run(jobs, outcome);
  const auto sorted = results.sort();
  if (!worked) return tl::make_unexpected(worked.error());
  if (!sorted) return tl::make_unexpected(sorted.error());
  return outcome;
}

}  // namespace handcast::sweep
