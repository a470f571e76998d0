// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/cascade_runs.hpp"

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "services/lab/simulate/score.hpp"

namespace handcast::bench {
namespace {

constexpr int kSideBySide = 2;
constexpr std::int64_t kProgress_ns = 5'000'000'000;

Result<nlohmann::json> simulate(const SimulatedRun& run, double seconds) {
  auto settings = run.settings;
  settings.push_back("twin.motion=" + run.motion);
  settings.push_back(fmt::format("twin.speed={}", run.speed));
  const auto rig = config::load_rig("config/rigs/twin.toml", settings);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto calibration = calib::load_calibration(rig->calibration);
  if (!calibration) return tl::make_unexpected(calibration.error());
  simulate::Options options;
  options.seconds = seconds;
  options.draw_every = run.draw_every;
  return simulate::score(*rig, *calibration, options);
}

/// Says how far it is, now and then.
class Progress {
 public:
  explicit Progress(std::size_t runs) : runs_(runs) {}

  void one_is_done(const std::string& error) {
    const std::scoped_lock lock(one_at_a_time_);
    ++done_;
    if (!error.empty()) fmt::print(stderr, "not measured: {}\n", error);
    const auto time_ns = now_ns();
    if (done_ < runs_ && time_ns - said_ns_ < kProgress_ns) return;
    said_ns_ = time_ns;
    const double elapsed_s = ns_to_seconds(time_ns - start_ns_);
    fmt::print(stderr, "{} of {} runs, about {:.0f} s left\n", done_, runs_,
               elapsed_s * static_cast<double>(runs_ - done_) / static_cast<double>(done_));
  }

 private:
  std::mutex one_at_a_time_;
  std::size_t runs_, done_ = 0;
  std::int64_t start_ns_ = now_ns(), said_ns_ = start_ns_;
};

}  // namespace

void simulate_all(std::vector<SimulatedRun>& runs, double seconds) {
  Progress progress(runs.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < runs.size(); i = next++) {
      auto metrics = simulate(runs[i], seconds);
      if (metrics) runs[i].metrics = std::move(*metrics);
      progress.one_is_done(metrics ? "" : metrics.error().what);
    }
  };
  std::vector<std::jthread> workers;
  for (int i = 0; i < kSideBySide; ++i) workers.emplace_back(work);
}

}  // namespace handcast::bench
