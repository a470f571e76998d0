// SPDX-License-Identifier: Apache-2.0
// handcast calibrate: measures lens, projector and tracker of a rig.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "calib/board/board_pdf.hpp"
#include "config/settings/choice.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "services/calibrate/check.hpp"
#include "services/calibrate/check_steps.hpp"
#include "services/calibrate/correct.hpp"
#include "services/calibrate/hand_over.hpp"
#include "services/calibrate/lens_step.hpp"
#include "services/calibrate/light_step.hpp"
#include "services/calibrate/own_devices.hpp"
#include "services/calibrate/pair_step.hpp"
#include "services/calibrate/points.hpp"
#include "services/calibrate/rig_settings.hpp"
#include "services/calibrate/screen_step.hpp"
#include "services/calibrate/tracker_step.hpp"

namespace handcast::calibrate {
namespace {

int complain(const Error& error) {
  fmt::print(stderr, "handcast calibrate: {}\n", printable(error.what));
  return exit_code_of(error);
}

struct StepEntry {
  Step step;
  Result<Outcome> (*measure)(Desk& desk);
  const char* instruction;
};

constexpr std::array kSteps{
    StepEntry{Step::lens, measure_lens,
              "Hold the printed board in front of the camera, still for a moment at each place: in "
              "the middle and in every corner of the image, near and far, tilted to all sides."},
    StepEntry{
        Step::lens2, measure_second_lens,
        "The same with the second camera: hold the board in the middle and in every corner of "
        "its image, near and far, tilted to all sides."},
    StepEntry{Step::pair, measure_pair,
              "Hold the board where both cameras see all of it, still for a moment at each place: "
              "near and far, left and right, tilted to all sides."},
    StepEntry{Step::screen, measure_screen,
              "Hold or stand the board in the projector's light, still until it asks for the next "
              "place: at three or more distances."},
    StepEntry{Step::tracker, measure_tracker,
              "Take the board away. Move an open hand slowly through the whole volume in which the "
              "show takes place, nearer and farther, too."},
    StepEntry{Step::light, measure_light,
              "Hold one open hand still in the middle of the camera's view, for ten seconds. The "
              "projector lights it white and dark in turns."},
};

constexpr const char* kReflectorInstruction =
    "Take the board away, and put the reflector on the very tip of an index finger. Expose so "
    "briefly that only the reflector is white. Move the stretched finger through the whole volume "
    "in which the show takes place, nearer and farther, too, and turn the hand.";

const StepEntry& entry_of(Step step) { return *std::ranges::find(kSteps, step, &StepEntry::step); }

/// The steps to do now.
std::vector<Step> steps_of(const Options& options, const config::Rig& rig, const Session& session) {
  std::vector<Step> steps = options.steps;
  if (!steps.empty()) return steps;
  for (const auto& entry : kSteps)
    if (has_need_of(rig, entry.step) && !session.is_done(entry.step)) steps.push_back(entry.step);
  return steps;
}

/// Waits until a person is ready. False if the step shall be left out. Error unavailable: the
/// program was asked to stop.
Result<bool> is_wanted(const Options& options, Keys& keys, const StepEntry& entry) {
  const bool by_reflector = entry.step == Step::tracker && options.reflector_mm > 0;
  fmt::print(stderr, "\n{}\n  {}\n", config::word_of(entry.step),
             by_reflector ? kReflectorInstruction : entry.instruction);
  if (options.yes || !keys.has_person()) return true;
  fmt::print(stderr, "  Enter begins, and ends the step early; s leaves it out\n");
  for (;;) {
    if (auto on = not_stopped(); !on) return tl::make_unexpected(on.error());
    if (const auto key = keys.pressed()) {
      if (key->character == '\n') return true;
      if (key->character == 's') return false;
    }
    sleep_until_ns(now_ns() + 20'000'000);
  }
}

void print_outcome(const Outcome& outcome) {
  fmt::print(stderr, "  {}\n", printable(outcome.made));
  for (const auto& finding : outcome.findings) fmt::print(stderr, "  - {}\n", printable(finding));
}

/// Starts the rig as a step needs it, and measures, which writes to the draft. `logs`: a folder for
/// what the rig prints.
Result<Outcome> with_rig(const Options& options, const RunningAs& running,
                         const std::filesystem::path& logs, calib::Calibration& draft, Keys& keys,
                         const StepEntry& entry) {
  const auto rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  std::vector<std::string> settings;
  if (rig->camera.backend == "twin") settings = twin_scene(entry.step, options);
  // What the person sets comes later, and wins.
  settings.insert(settings.end(), running.settings.begin(), running.settings.end());
  const auto as_it_runs = config::load_rig(options.rig_file, settings);
  if (!as_it_runs) return tl::make_unexpected(as_it_runs.error());
  auto own_rig = OwnRig::start(options.rig_file, rig->name, settings,
                               logs / fmt::format("{}.log", config::word_of(entry.step)));
  if (!own_rig) return tl::make_unexpected(own_rig.error());
  auto screen = TestScreen::open(rig->name, running.calibration.projector_width_px,
                                 running.calibration.projector_height_px);
  if (!screen) return tl::make_unexpected(screen.error());
  Desk desk{options, *as_it_runs, running.calibration, draft, *own_rig, *screen, keys};
  return entry.measure(desk);
}

/// Does one step, and keeps what it has measured. False if the person has left the step out.
Result<bool> do_step(const Options& options, const RunningAs& running, Session& session, Keys& keys,
                     const StepEntry& entry) {
  auto wanted = is_wanted(options, keys, entry);
  if (!wanted || !*wanted) return wanted;
  auto draft = session.draft();
  const auto outcome =
      with_rig(options, running, session.report().parent_path(), draft, keys, entry);
  if (!outcome) return tl::make_unexpected(outcome.error());
  print_outcome(*outcome);
  return session.keep(entry.step, *outcome, draft).map([] { return true; });
}

/// Measures what is left, or was asked for. `done`: how many steps.
Result<void> measure_steps(const Options& options, const RunningAs& running, Session& session,
                           std::span<const Step> steps, int& done) {
  Keys keys;
  for (const Step step : steps) {
    const auto kept = do_step(options, running, session, keys, entry_of(step));
    if (!kept) return fail_in(config::word_of(step), kept.error());
    done += *kept ? 1 : 0;
  }
  return {};
}

/// What was measured, now or in an earlier call, gets its place even if a later step has failed.
Result<int> measure_all(const Options& options, const config::Rig& rig, const RunningAs& running,
                        Session& session) {
  const auto steps = steps_of(options, rig, session);
  int done = 0;
  const auto measured = measure_steps(options, running, session, steps, done);
  if (done > 0)
    fmt::print("the report is {}\n", session.report().string());
  else if (measured)
    fmt::print("{}\n", steps.empty() ? "nothing is left to be measured; --restart begins anew"
                                     : "nothing was measured");
  const auto handed_over = hand_over(options, rig, running.calibration, session);
  if (measured) return handed_over.map([] { return kExitDone; });
  if (!handed_over) complain(handed_over.error());
  return tl::make_unexpected(measured.error());
}

/// A part of --check.
struct Check {
  Step step;  ///< whose scene and calibration it is about
  Result<Outcome> (*measure)(Desk& desk);
  const char* instruction;
};

constexpr std::array kChecks{
    Check{Step::tracker, check_tracker,
          "Move an open hand through the middle of the volume, nearer and farther."},
    Check{Step::screen, check_screen, "Hold or stand the board in the projector's light, still."},
};

/// Compares an installed rig with its calibration. kExitBadResult if it has moved. `logs`: a folder
/// for what the rig prints.
Result<int> check_rig(const Options& options, const config::Rig& rig, const RunningAs& running,
                      const std::filesystem::path& logs) {
  Keys keys;
  bool is_good = true;
  for (const auto& check : kChecks) {
    if (!has_need_of(rig, check.step)) continue;
    const StepEntry entry{check.step, check.measure, check.instruction};
    auto wanted = is_wanted(options, keys, entry);
    if (!wanted) return tl::make_unexpected(wanted.error());
    if (!*wanted) continue;
    auto draft = running.calibration;
    const auto outcome = with_rig(options, running, logs, draft, keys, entry);
    if (!outcome) return fail_in(config::word_of(check.step), outcome.error());
    print_outcome(*outcome);
    fmt::print("{}: {}\n", config::word_of(check.step),
               !outcome->is_checked ? "not checked"
               : outcome->is_good   ? "as calibrated"
                                    : "has moved");
    is_good = is_good && outcome->is_good;
  }
  return is_good ? kExitDone : kExitBadResult;
}

Result<int> check_installed(const Options& options, const config::Rig& rig,
                            const RunningAs& running) {
  std::error_code error;
  const auto logs =
      std::filesystem::temp_directory_path(error) / fmt::format("handcast-check-{}", now_ns());
  std::filesystem::create_directories(logs, error);
  if (error)
    return fail(Errc::unavailable,
                fmt::format("the folder '{}' cannot be made: {}", logs.string(), error.message()));
  auto checked = check_rig(options, rig, running, logs);
  std::filesystem::remove_all(logs, error);
  return checked;
}

Result<int> print_board(const Options& options) {
  return write_whole(options.board_pdf, calib::board_pdf(options.board)).map([&] {
    fmt::print("{}: print it at true scale (100 %), and glue it on something flat\n",
               options.board_pdf.string());
    return kExitDone;
  });
}

/// Files for devices that are not those of the rig's calibration have names of their own.
void name_anew(Options& options, config::Rig& rig, const std::string& devices) {
  const std::filesystem::path old(rig.calibration);
  rig.calibration = (old.parent_path() / (old.stem().string() + "." + devices + ".toml")).string();
  if (options.folder == std::filesystem::path(options.rig_file).replace_extension(".calibration"))
    options.folder.replace_extension(devices + ".calibration");
}

Result<int> run(Options options) {
  if (!options.board_pdf.empty()) return print_board(options);
  auto rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto done = [] { return kExitDone; };
  // Also if the calibration cannot be read any more.
  if (options.undo) return undo(*rig).map(done);
  if (auto possible = check_steps(options, *rig); !possible)
    return tl::make_unexpected(possible.error());
  const auto own = own_devices(*rig);
  const auto running = rig_as_it_runs(options, *rig, own);
  if (!running) return tl::make_unexpected(running.error());
  if (!options.points.empty())
    return judge_points(options.points, running->calibration.camera).map(done);
  if (options.correct) return correct_tracker(options, *rig, running->calibration).map(done);
  if (options.check && !running->new_devices.empty())
    return fail(Errc::bad_config,
                "--check needs a calibration of the devices that the rig has now");
  if (options.check) return check_installed(options, *rig, *running);
  const auto named = rig->calibration;
  if (!running->new_devices.empty()) name_anew(options, *rig, running->new_devices);
  auto used = running->calibration;
  if (used.camera_device.empty()) used.camera_device = own.camera;
  if (used.camera2 && used.camera2->device.empty()) used.camera2->device = own.camera2;
  if (used.projector_device.empty()) used.projector_device = own.projector;
  auto session = Session::open(options, *rig, used);
  if (!session) return tl::make_unexpected(session.error());
  rig->calibration = named;
  return measure_all(options, *rig, *running, *session);
}

int run_verb(int argc, char** argv) {
  auto options = parse(argc, argv);
  if (!options) {
    fmt::print(stderr, "handcast calibrate: {}\n", printable(options.error().what));
    return kExitUsage;
  }
  if (!options->text.empty()) {
    fmt::print("{}", options->text);
    return kExitDone;
  }
  daemon::install_stop_signals();
  const auto done = run(std::move(*options));
  return done ? *done : complain(done.error());
}

}  // namespace
}  // namespace handcast::calibrate

int main(int argc, char** argv) {
  return handcast::run_program("handcast calibrate", argc, argv, handcast::calibrate::run_verb);
}
