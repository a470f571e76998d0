// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/sub_frames.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/lab/simulate/score.hpp"

namespace handcast::simulate {
namespace {

/// Progress on stderr: one line that is overwritten on a terminal, else a line every 10 %.
class Progress {
 public:
  Progress(std::string rig, double seconds, bool quiet)
      : rig_(std::move(rig)),
        seconds_(seconds),
        quiet_(quiet),
        tty_(inherited::is_terminal(STDERR_FILENO)) {}
  ~Progress() {
    if (tty_ && !quiet_) log::put("\n");
  }

  void at(double done_s) {
    const int percent = static_cast<int>(100 * done_s / seconds_);
    if (quiet_ || percent < shown_ + (tty_ ? 1 : 10)) return;
    shown_ = percent;
    log::put(fmt::format("{}simulate {}: {:4.1f} of {:.1f} s, {:3d} %{} {}", tty_ ? "\r" : "", rig_,
                         done_s, seconds_, percent, estimate(done_s), tty_ ? "  " : "\n"));
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

/// Prints why another detector has run than the rig names, and its accuracy if it is a real one.
void print_detector(const nlohmann::json& detector) {
  if (detector["why"].is_string()) fmt::print("{}\n", detector["why"].get<std::string>());
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

/// The number at a JSON pointer, or "unknown". `form`: with one {}, which takes the number.
std::string text_of(const nlohmann::json& json, const char* pointer, const char* form) {
  const nlohmann::json::json_pointer place(pointer);
  if (!json.contains(place) || !json[place].is_number()) return "unknown";
  return fmt::format(fmt::runtime(form), json[place].get<double>());
}

void print_summary(const nlohmann::json& json, const config::Rig& rig, const Options& options) {
  const auto text = [&](const char* pointer, const char* form) {
    return text_of(json, pointer, form);
  };
  if (options.draw_every == 0) {
    fmt::print("{} on {}: landmark error mean {}, p95 {}; jitter {}\n", rig.name, rig.twin.motion,
               text("/landmark_mm/mean", "{:.2f} mm"), text("/landmark_mm/p95", "{:.2f} mm"),
               text("/landmark_jitter_px", "{:.3f} px"));
    return;
  }
  fmt::print(
      "{} on {}: interior error mean {}, p95 {}; coverage {}, spill {}; jitter {}; {} frames, {} "
      "each (p50)\n",
      rig.name, rig.twin.motion, text("/interior_mm/mean", "{:.2f} mm"),
      text("/interior_mm/p95", "{:.2f} mm"), text("/coverage", "{:.4f}"), text("/spill", "{:.4f}"),
      text("/jitter_px", "{:.3f} px"), text("/frames", "{:.0f}"),
      text("/frame_us/p50", "{:.0f} us"));
}

/// What both projectors of a rig do together.
void print_shared(const nlohmann::json& json) {
  if (!json["shared"].is_object()) return;
  const auto text = [&](const char* pointer, const char* form) {
    return text_of(json["shared"], pointer, form);
  };
  if (!json["shared"]["coverage"].is_number()) {
    fmt::print(
        "both projectors: apart {} (mean); their light is measured on white hands: --set "
        "content.left=builtin:white --set content.right=builtin:white\n",
        text("/apart_mm/mean", "{:.1f} mm"));
    return;
  }
  fmt::print(
      "both projectors: coverage {} (the first alone {}), light {} (p5) to {} (p95), step between "
      "neighbours {} (p99), apart {} (mean)\n",
      text("/coverage", "{:.3f}"), text("/coverage_first", "{:.3f}"), text("/light/p5", "{:.2f}"),
      text("/light/p95", "{:.2f}"), text("/step/p99", "{:.2f}"),
      text("/apart_mm/mean", "{:.1f} mm"));
}

/// Why the metrics say nothing about the rig. Empty if they do.
std::string fault_of(const nlohmann::json& json, const Options& options) {
  if (auto why = why_nothing_was_scored(json, options); !why.empty() || options.draw_every == 0)
    return why;
  if (json["coverage"] == 0) return "no light fell on a hand: coverage is 0";
  return json["interior_mm"]["mean"].is_number()
             ? ""
             : "no landing of the light could be compared with a hand";
}

}  // namespace

Result<std::string> run(const Options& options) {
  if (!options.json_file.empty())
    if (auto writable = check_result_file(options.json_file); !writable)
      return tl::make_unexpected(writable.error());
  const auto rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto calibration =
      calib::load_calibration(rig->calibration, rig->projector, rig->projector2);
  if (!calibration) return tl::make_unexpected(calibration.error());

  const auto json = score_in_sight(*rig, *calibration, options);
  if (!json) return tl::make_unexpected(json.error());
  print_summary(*json, *rig, options);
  for (const auto& [what, file] :
       {std::pair{"poses", options.poses_file}, std::pair{"landmarks", options.landmarks_file}})
    if (!file.empty()) fmt::print("the {} were those of {}\n", what, file);
  print_shared(*json);
  print_detector((*json)["detector"]);
  if (!options.json_file.empty()) {
    // Paths and names in the metrics need not be UTF-8.
    const auto text = json->dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    if (auto written = write_whole(options.json_file, text); !written)
      return tl::make_unexpected(written.error());
  }
  return fault_of(*json, options);
}

int run_verb(std::string_view verb, const Result<Options>& options) {
  const auto text = options.map([](const auto& each) { return each.text; });
  if (const auto code = answered(verb, text)) return *code;
  const auto fault = run(*options);
  if (fault && fault->empty()) return kExitDone;
  fmt::print(stderr, "{}: {}\n", verb, printable(fault ? *fault : fault.error().what));
  return fault ? kExitBadResult : exit_code_of(fault.error());
}

}  // namespace handcast::simulate
