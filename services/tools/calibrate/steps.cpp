// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "calib/solve/board/board_name.hpp"
#include "config/settings/choice.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/msg/camera_frame.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// In the order in which they are measured.
constexpr std::array kMeasuringOrder{&kLensStep,   &kSecondLensStep, &kPairStep,
                                     &kScreenStep, &kTrackerStep,    &kLightStep};
/// In the order in which they are checked: a hand first, then the board.
constexpr std::array kCheckingOrder{&kTrackerStep, &kPairStep, &kScreenStep};

/// Says what to do, and waits until a person is ready. False if the step shall be left out.
Result<bool> is_wanted(const Options& options, Keys& keys, const StepEntry& entry) {
  fmt::print(stderr, "\n{}\n  {}\n", config::word_of(entry.step), entry.instruct(options));
  if (options.yes) return true;
  return keys.confirm("Enter begins, and ends the step early; s leaves it out");
}

Result<OwnRig> rig_of(const Options& options, const std::string& name,
                      const std::vector<std::string>& settings, const fs::path& log, bool is_up) {
  if (is_up) return OwnRig::beside(name);
  fmt::print(stderr, "  the rig starts\n");
  return OwnRig::start(options.rig_file, name, settings, log);
}

/// Starts the rig as a step needs it, or, if `is_up`, uses the one that runs; measures, or checks
/// if options.check. Prints the outcome.
Result<Outcome> with_rig(const Options& options, const RunningAs& running, const fs::path& logs,
                         calib::Calibration& draft, Keys& keys, const StepEntry& entry,
                         bool is_up) {
  const auto rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  std::vector<std::string> settings;
  if (rig->camera.backend == "twin" && !is_up) {
    settings = entry.scene(options, rig->camera.rate_hz);
    // Whole pictures at 946 Hz take a core. 57 Hz keeps step with no usual rate of a camera.
    settings.emplace_back("projector.rate_hz=57");
  }
  // What the person sets comes later, and wins.
  settings.insert(settings.end(), running.settings.begin(), running.settings.end());
  const auto as_it_runs = config::load_rig(options.rig_file, settings);
  if (!as_it_runs) return tl::make_unexpected(as_it_runs.error());
  auto own_rig = rig_of(options, rig->name, settings,
                        logs / fmt::format("{}.log", config::word_of(entry.step)), is_up);
  if (!own_rig) return tl::make_unexpected(own_rig.error());
  auto screen = TestScreen::open(rig->name, running.calibration.projector.width_px,
                                 running.calibration.projector.height_px);
  if (!screen) return tl::make_unexpected(screen.error());
  Desk desk{options, *as_it_runs, running.calibration, draft, *own_rig, *screen, keys};
  auto outcome = options.check ? entry.check(desk) : entry.measure(desk);
  if (!outcome) return outcome;
  fmt::print(stderr, "  {}\n", printable(outcome->made));
  for (const auto& finding : outcome->findings) fmt::print(stderr, "  - {}\n", printable(finding));
  return outcome;
}

bool is_up(const config::Rig& rig) { return client::stream_names(rig.name, 500ms).has_value(); }

/// Error bad_config: the rig that is up is not what would be checked.
Result<void> check_running(const Options& options, const config::Rig& rig,
                           const calib::Calibration& calibration) {
  if (!options.settings.empty())
    return fail(Errc::bad_config,
                fmt::format("the rig '{}' is up, and --set cannot change it; leave --set out, or "
                            "stop the rig with `handcast down`",
                            rig.name));
  auto frames = client::open_stream<msg::CameraFrame>(rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  const auto frame = frames->latest(Deadline::in(2s));
  if (!frame) return fail_in("camera", frame.error());
  if ((*frame)->calibration == 0 || (*frame)->calibration == calibration.id) return {};
  return fail(Errc::bad_config,
              fmt::format("the rig '{}' is up with another calibration than the file has now: "
                          "`handcast reload` first",
                          rig.name));
}

/// One part of --check. True if it has not moved, was left out, or cannot be checked.
Result<bool> do_check(const Options& options, const RunningAs& running, const fs::path& logs,
                      Keys& keys, const StepEntry& entry, bool is_up) {
  const auto wanted = is_wanted(options, keys, entry);
  if (!wanted) return tl::make_unexpected(wanted.error());
  if (!*wanted) return true;
  auto draft = running.calibration;
  const auto outcome = with_rig(options, running, logs, draft, keys, entry, is_up);
  if (!outcome) return tl::make_unexpected(outcome.error());
  fmt::print("{}: {}\n", config::word_of(entry.step),
             !outcome->is_checked ? "not checked"
             : outcome->is_good   ? "as calibrated"
                                  : "has moved");
  return outcome->is_good;
}

Result<int> check_all(const Options& options, const config::Rig& rig, const RunningAs& running,
                      const fs::path& logs, bool is_up) {
  Keys keys;
  bool is_good = true;
  for (const auto* entry : kCheckingOrder) {
    if (!has_need_of(rig, entry->step)) continue;
    const auto good = do_check(options, running, logs, keys, *entry, is_up);
    if (!good) return fail_in(config::word_of(entry->step), good.error());
    is_good = is_good && *good;
  }
  return is_good ? kExitDone : kExitBadResult;
}

}  // namespace

const StepEntry& entry_of(Step step) {
  return **std::ranges::find(kMeasuringOrder, step, &StepEntry::step);
}

std::vector<Step> steps_of(const Options& options, const config::Rig& rig, const Session& session) {
  std::vector<Step> steps = options.steps;
  if (!steps.empty()) return steps;
  for (const auto* entry : kMeasuringOrder)
    if (concerns(options, entry->step) && has_need_of(rig, entry->step) &&
        !session.is_done(entry->step))
      steps.push_back(entry->step);
  return steps;
}

std::vector<std::string> board_scene(const Options& options, double hold_s) {
  return {"twin.prop.kind=board", "twin.prop.board=" + calib::print_board_name(options.board),
          fmt::format("twin.prop.hold_s={:.1f}", hold_s)};
}

Result<std::optional<Outcome>> measure_step(const Options& options, const RunningAs& running,
                                            const fs::path& logs, calib::Calibration& draft,
                                            Keys& keys, Step step) {
  const auto wanted = is_wanted(options, keys, entry_of(step));
  if (!wanted) return tl::make_unexpected(wanted.error());
  if (!*wanted) return std::nullopt;
  return with_rig(options, running, logs, draft, keys, entry_of(step), false)
      .map([](Outcome&& outcome) { return std::optional(std::move(outcome)); });
}

Result<void> check_down(const config::Rig& rig) {
  if (!is_up(rig)) return {};
  return fail(Errc::bad_config,
              fmt::format("the rig '{}' is up, and each step starts it anew: stop it with "
                          "`handcast down`, then call this again",
                          rig.name));
}

Result<int> check_installed(const Options& options, const config::Rig& rig,
                            const RunningAs& running) {
  const bool runs = is_up(rig);
  if (runs) {
    if (auto same = check_running(options, rig, running.calibration); !same)
      return tl::make_unexpected(same.error());
    fmt::print(stderr,
               "the rig '{}' is up and goes on; while it is checked, the projector shows text and "
               "patterns in place of the show\n",
               rig.name);
  }
  std::error_code error;
  const auto logs = fs::temp_directory_path(error) / fmt::format("handcast-check-{}", now_ns());
  fs::create_directories(logs, error);
  if (error)
    return fail(Errc::unavailable,
                fmt::format("the folder '{}' cannot be made: {}", logs.string(), error.message()));
  auto checked = check_all(options, rig, running, logs, runs);
  fs::remove_all(logs, error);
  return checked;
}

}  // namespace handcast::calibrate
