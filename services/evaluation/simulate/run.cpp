// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/simulate/run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/calibration.hpp"
#include "config/settings/files.hpp"
#include "ipc/base/clock.hpp"
#include "services/evaluation/simulate/score.hpp"

namespace handcast::simulate {
namespace {

/// Progress on stderr: one line that is overwritten on a terminal, else a line every 10 %.
class Progress {
 public:
  Progress(std::string rig, double seconds, bool quiet)
      : rig_(std::move(rig)), seconds_(seconds), quiet_(quiet), tty_(isatty(STDERR_FILENO)) {}
  ~Progress() {
    if (tty_ && !quiet_) fmt::print(stderr, "\n");
  }

  void at(double done_s) {
    const int percent = static_cast<int>(100 * done_s / seconds_);
    if (quiet_ || percent < shown_ + (tty_ ? 1 : 10)) return;
    shown_ = percent;
    fmt::print(stderr, "{}simulate {}: {:4.1f} of {:.1f} s, {:3d} %{} {}", tty_ ? "\r" : "", rig_,
               done_s, seconds_, percent, estimate(done_s), tty_ ? "  " : "\n");
  }

 private:
  /// ", about 12 s left", once enough is done to tell.
  std::string estimate(double done_s) const {
    const double elapsed_s = ns_to_seconds(now_ns() - start_ns_);
    const double done = done_s / seconds_;
    if (done < 0.1 || done >= 1) return {};
    return fmt::format(", about {:.0f} s left", std::ceil(elapsed_s * (1 - done) / done));
  }

  std::string rig_;
  double seconds_;
  bool quiet_, tty_;
  int shown_ = -10;
  std::int64_t start_ns_ = now_ns();
};

Result<nlohmann::json> score_in_sight(const config::Rig& rig, const calib::Calibration& calibration,
                                      const Options& options) {
  Progress progress(rig.name, simulated_s(rig, options), options.quiet);
  return score(rig, calibration, options, [&](double done_s) { progress.at(done_s); });
}

/// Prints the accuracy of the detector if a real one has run.
void print_detector(const nlohmann::json& detector) {
  if (!detector["ms_p50"].is_number()) return;
  const auto error_px = detector["error_px"]["p50"];
  fmt::print(
      "{}: {} runs of {:.1f} ms (p50, this machine), simulated with an age of {:.1f} ms; {} of {} "
      "hands missed; error {} (p50)\n",
      detector["backend"].get<std::string>(), detector["runs"].get<long>(),
      detector["ms_p50"].get<double>(), detector["age_ms"].get<double>(),
      detector["missed"].get<long>(), detector["hands"].get<long>(),
      error_px.is_number() ? fmt::format("{:.1f} px", error_px.get<double>()) : "unknown");
}

void print_summary(const nlohmann::json& json, const config::Rig& rig, const Options& options) {
  const auto number = [&](const char* group, const char* key) {
    return json.contains(group) && json[group].contains(key) && json[group][key].is_number()
               ? json[group][key].get<double>()
               : 0.0;
  };
  const auto plain = [&](const char* key) {
    return json.contains(key) && json[key].is_number() ? json[key].get<double>() : 0.0;
  };
  if (options.draw_every == 0) {
    fmt::print("{} on {}: landmark error mean {:.2f} mm, p95 {:.2f} mm; jitter {:.3f} px\n",
               rig.name, rig.twin.motion, number("landmark_mm", "mean"),
               number("landmark_mm", "p95"), plain("jitter_px"));
    return;
  }
  fmt::print(
      "{} on {}: interior error mean {:.2f} mm, p95 {:.2f} mm; coverage {:.4f}, spill {:.4f}; "
      "jitter {:.3f} px; {} frames, {:.0f} us "
      "each (p50)\n",
      rig.name, rig.twin.motion, number("interior_mm", "mean"), number("interior_mm", "p95"),
      plain("coverage"), plain("spill"), plain("jitter_px"), static_cast<long>(plain("frames")),
      number("frame_us", "p50"));
}

}  // namespace

Result<void> run(const Options& options) {
  if (!options.json_file.empty())
    if (auto writable = config::check_writable(options.json_file); !writable) return writable;
  const auto rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto calibration = calib::load_calibration(rig->calibration);
  if (!calibration) return tl::make_unexpected(calibration.error());

  const auto json = score_in_sight(*rig, *calibration, options);
  if (!json) return tl::make_unexpected(json.error());
  print_summary(*json, *rig, options);
  print_detector((*json)["detector"]);
  if (options.json_file.empty()) return {};
  // Paths and names in the metrics need not be UTF-8.
  return config::write_whole(
      options.json_file,
      json->dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace handcast::simulate
