// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/runner.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "ipc/base/clock.hpp"
#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"
#include "services/lab/simulate/score.hpp"
#include "services/lab/sweep/columns.hpp"
#include "services/lab/sweep/results.hpp"

namespace handcast::sweep {
namespace {

/// Prints the progress of a sweep on stderr: one line that is overwritten on a terminal, else a
/// line every 10 %. Thread-safe.
class Progress {
 public:
  /// `plan` is printed before the progress. If `quiet`, only say() prints.
  Progress(std::string plan, std::size_t runs, bool quiet);
  /// Ends the line on a terminal.
  ~Progress();

  /// Counts a run.
  void one_done(bool failed);
  /// Prints a message on a line of its own.
  void say(const std::string& sentence);

 private:
  void show();

  std::string plan_;
  std::size_t runs_;
  bool quiet_, terminal_;
  std::mutex mutex_;
  std::size_t done_ = 0, failed_ = 0, tenths_ = 0;
  std::int64_t start_ns_, shown_ns_ = 0;
};

constexpr const char* kClearLine = "\r\033[K";
constexpr std::int64_t kPause_ns = 100'000'000;  ///< least time between updates of the terminal

std::string print_span(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

Progress::Progress(std::string plan, std::size_t runs, bool quiet)
    : plan_(std::move(plan)),
      runs_(runs),
      quiet_(quiet),
      terminal_(inherited::is_terminal(STDERR_FILENO)),
      start_ns_(now_ns()) {}

Progress::~Progress() {
  if (terminal_ && !quiet_ && done_ > 0) log::put("\n");
}

void Progress::one_done(bool failed) {
  const std::lock_guard lock(mutex_);
  ++done_;
  failed_ += failed;
  const auto tenths = 10 * done_ / runs_;
  const bool due =
      terminal_ ? now_ns() >= shown_ns_ + kPause_ns || done_ == runs_ : tenths > tenths_;
  tenths_ = tenths;
  if (due && !quiet_) show();
}

void Progress::say(const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  log::put(fmt::format("{}{}\n", terminal_ ? kClearLine : "", sentence));
}

void Progress::show() {
  shown_ns_ = now_ns();
  const auto elapsed_s = ns_to_seconds(shown_ns_ - start_ns_);
  const auto rate_hz = static_cast<double>(done_) / elapsed_s;
  log::put(fmt::format("{}sweep {}: {} of {} runs, {} %{}, {:.3g} runs a second, about {} left{}",
                       terminal_ ? kClearLine : "", plan_, done_, runs_, 100 * done_ / runs_,
                       failed_ ? fmt::format(", {} failed", failed_) : "", rate_hz,
                       print_span(static_cast<double>(runs_ - done_) / rate_hz),
                       terminal_ ? "" : "\n"));
}

simulate::Options options_of(const Plan& plan, const Run& run, const config::Rig& rig,
                             const std::filesystem::path& record) {
  simulate::Options options;
  const auto number = case_of(plan, run);
  options.poses_file = results_file(plan.variants[run.variant].poses, number);
  options.landmarks_file = results_file(plan.variants[run.variant].landmarks, number);
  if (!record.empty()) options.record_directory = record / fmt::format("{:03}", number);
  options.seconds = plan.seconds;
  options.warm_up_s = plan.warm_up_s;
  options.draw_every =
      plan.draw_hz > 0
          ? std::max(static_cast<int>(std::lround(rig.projector.rate_hz / plan.draw_hz)), 1)
          : plan.draw_every;
  if (!record.empty()) options.draw_every = 0;
  return options;
}

Result<nlohmann::json> score(const Plan& plan, const Run& run, const std::string& record) try {
  const auto rig = rig_of(plan, run);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto calibration =
      calib::load_calibration(rig->calibration, rig->projector, rig->projector2);
  if (!calibration) return tl::make_unexpected(calibration.error());
  const auto options = options_of(plan, run, *rig, record);
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
    if (const auto why = rig ? why_absent(plan, run, *rig) : std::nullopt) {
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
          const std::atomic<bool>& stop, const Work& work)
      : plan_(plan),
        todo_(todo),
        results_(results),
        stop_(stop),
        record_(work.record),
        progress_(plan.name, todo.size(), work.quiet) {}

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
    const auto json = score(plan_, run, record_);
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
  std::string record_;
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
  const auto worked = Workers(plan, todo, results, stop, work).run(jobs, outcome);
  const auto sorted = results.sort();
  if (!worked) return tl::make_unexpected(worked.error());
  if (!sorted) return tl::make_unexpected(sorted.error());
  return outcome;
}

}  // namespace handcast::sweep
