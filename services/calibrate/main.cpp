// SPDX-License-Identifier: Apache-2.0
// handcast calibrate: measures lens, projector and tracker of a rig.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "calib/board/board_pdf.hpp"
#include "config/settings/choice.hpp"
#include "config/settings/files.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "services/calibrate/lens_step.hpp"
#include "services/calibrate/own_devices.hpp"
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
    StepEntry{Step::screen, measure_screen,
              "Hold or stand the board in the projector's light, still until it asks for the next "
              "place: at three or more distances."},
    StepEntry{Step::tracker, measure_tracker,
              "Take the board away. Move an open hand slowly through the whole volume in which the "
              "show takes place, nearer and farther, too."},
};

const StepEntry& entry_of(Step step) { return *std::ranges::find(kSteps, step, &StepEntry::step); }

/// The steps to do now.
std::vector<Step> steps_of(const Options& options, const config::Rig& rig, const Session& session) {
  std::vector<Step> steps = options.steps;
  if (!steps.empty()) return steps;
  for (const auto& entry : kSteps) {
    const bool needless = entry.step == Step::tracker && rig.pose.backend == "none";
    if (!needless && !session.is_done(entry.step)) steps.push_back(entry.step);
  }
  return steps;
}

/// Waits until a person is ready. False if the step shall be left out. Error unavailable: the
/// program was asked to stop.
Result<bool> is_wanted(const Options& options, Keys& keys, const StepEntry& entry) {
  fmt::print(stderr, "\n{}\n  {}\n", config::word_of(entry.step), entry.instruction);
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

/// Starts the rig as a step needs it, and calls `measure`, which writes to the draft.
Result<Outcome> with_rig(const Options& options, const config::Rig& rig, const RunningAs& running,
                         const Session& session, calib::Calibration& draft, Keys& keys,
                         const StepEntry& entry, Result<Outcome> (*measure)(Desk& desk)) {
  std::vector<std::string> settings;
  if (rig.camera.backend == "twin") settings = twin_scene(entry.step, options.board);
  // What the person sets comes later, and wins.
  settings.insert(settings.end(), running.settings.begin(), running.settings.end());
  const auto as_it_runs = config::load_rig(options.rig_file, settings);
  if (!as_it_runs) return tl::make_unexpected(as_it_runs.error());
  auto own_rig = OwnRig::start(options.rig_file, rig.name, settings,
                               session.file(fmt::format("{}.log", config::word_of(entry.step))));
  if (!own_rig) return tl::make_unexpected(own_rig.error());
  auto screen = TestScreen::open(rig.name, running.calibration.projector_width_px,
                                 running.calibration.projector_height_px);
  if (!screen) return tl::make_unexpected(screen.error());
  Desk desk{options, *as_it_runs, running.calibration, draft, *own_rig, *screen, keys};
  return measure(desk);
}

/// Does one step, and keeps what it has measured. False if the person has left the step out.
Result<bool> do_step(const Options& options, const config::Rig& rig, const RunningAs& running,
                     Session& session, Keys& keys, const StepEntry& entry) {
  auto wanted = is_wanted(options, keys, entry);
  if (!wanted || !*wanted) return wanted;
  auto draft = session.draft();
  const auto outcome = with_rig(options, rig, running, session, draft, keys, entry, entry.measure);
  if (!outcome) return tl::make_unexpected(outcome.error());
  print_outcome(*outcome);
  return session.keep(entry.step, *outcome, draft).map([] { return true; });
}

Result<void> measure_all(const Options& options, const config::Rig& rig, const RunningAs& running,
                         Session& session) {
  Keys keys;
  const auto steps = steps_of(options, rig, session);
  int done = 0;
  for (const Step step : steps) {
    const auto kept = do_step(options, rig, running, session, keys, entry_of(step));
    if (!kept) return fail_in(config::word_of(step), kept.error());
    if (*kept) ++done;
  }
  if (done == 0) {
    fmt::print("{}\n", steps.empty() ? "nothing is left to be measured; --restart begins anew"
                                     : "nothing was measured");
    return {};
  }
  fmt::print("the report is {}\n", session.report().string());
  const auto finished = session.finish();
  if (!finished) return tl::make_unexpected(finished.error());
  fmt::print("{}\n", *finished);
  if (rig.calibration.empty())
    fmt::print("name it in {}, above the first section:\n  calibration = \"{}\"\n",
               options.rig_file.string(), session.target().filename().string());
  return {};
}

Result<void> check_rig(const Options& options, const config::Rig& rig, const RunningAs& running,
                       Session& session) {
  Keys keys;
  const auto& entry = entry_of(Step::tracker);
  auto wanted = is_wanted(options, keys, entry);
  if (!wanted) return tl::make_unexpected(wanted.error());
  if (!*wanted) return {};
  auto draft = running.calibration;
  const auto outcome = with_rig(options, rig, running, session, draft, keys, entry, check_tracker);
  if (!outcome) return tl::make_unexpected(outcome.error());
  print_outcome(*outcome);
  return {};
}

Result<void> run(Options options) {
  if (!options.board_pdf.empty())
    return config::write_whole(options.board_pdf, calib::board_pdf(options.board)).map([&] {
      fmt::print("{}: print it at true scale (100 %), and glue it on something flat\n",
                 options.board_pdf.string());
    });
  const auto rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto running = rig_as_it_runs(options, *rig);
  if (!running) return tl::make_unexpected(running.error());
  auto used = running->calibration;
  const auto own = own_devices(*rig);
  if (used.camera_device.empty()) used.camera_device = own.camera;
  if (used.projector_device.empty()) used.projector_device = own.projector;
  auto session = Session::open(options, *rig, used);
  if (!session) return tl::make_unexpected(session.error());
  return options.check ? check_rig(options, *rig, *running, *session)
                       : measure_all(options, *rig, *running, *session);
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
  return done ? kExitDone : complain(done.error());
}

}  // namespace
}  // namespace handcast::calibrate

int main(int argc, char** argv) {
  return handcast::run_program("handcast calibrate", argc, argv, handcast::calibrate::run_verb);
}
