// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/installed.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "config/settings/choice.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/tools/calibrate/check.hpp"
#include "services/tools/calibrate/check_steps.hpp"
#include "services/tools/calibrate/pair_check.hpp"
#include "services/tools/calibrate/steps.hpp"
#include "services/tools/calibrate/tracker_step.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr std::array kChecks{
    StepEntry{Step::tracker, check_tracker,
              "Move an open hand through the middle of the volume, nearer and farther."},
    StepEntry{Step::pair, check_pair, "Hold the board still where both cameras see all of it."},
    StepEntry{Step::screen, check_screen,
              "Hold or stand the board in the projector's light, still."},
};

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
                      Keys& keys, const StepEntry& check, bool is_up) {
  const auto wanted = is_wanted(options, keys, check);
  if (!wanted) return tl::make_unexpected(wanted.error());
  if (!*wanted) return true;
  auto draft = running.calibration;
  const auto outcome = with_rig(options, running, logs, draft, keys, check, is_up);
  if (!outcome) return tl::make_unexpected(outcome.error());
  fmt::print("{}: {}\n", config::word_of(check.step),
             !outcome->is_checked ? "not checked"
             : outcome->is_good   ? "as calibrated"
                                  : "has moved");
  return outcome->is_good;
}

Result<int> check_all(const Options& options, const config::Rig& rig, const RunningAs& running,
                      const fs::path& logs, bool is_up) {
  Keys keys;
  bool is_good = true;
  for (const auto& check : kChecks) {
    if (!has_need_of(rig, check.step)) continue;
    const auto good = do_check(options, running, logs, keys, check, is_up);
    if (!good) return fail_in(config::word_of(check.step), good.error());
    is_good = is_good && *good;
  }
  return is_good ? kExitDone : kExitBadResult;
}

}  // namespace

bool is_up(const config::Rig& rig) { return client::stream_names(rig.name, 500ms).has_value(); }

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
