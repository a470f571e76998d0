// SPDX-License-Identifier: Apache-2.0
// handcast calibrate: measures the lens of each camera, the place of a second one, projector,
// tracker and light of a rig; --check compares an installed rig with its calibration.
#include <fmt/format.h>

#include <span>
#include <vector>

#include "calib/solve/board/board_pdf.hpp"
#include "config/settings/choice.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "services/tools/calibrate/hand_over.hpp"
#include "services/tools/calibrate/programs.hpp"
#include "services/tools/calibrate/second_projector.hpp"
#include "services/tools/calibrate/steps.hpp"
#include "services/tools/calibrate/tracker_tasks.hpp"

namespace handcast::calibrate {
namespace {

int complain(const Error& error) {
  fmt::print(stderr, "handcast calibrate: {}\n", printable(error.what));
  return exit_code_of(error);
}

/// What a call has measured.
struct Measured {
  int steps = 0;
  Result<void> page;  ///< whether the last one could be written
};

/// Does one step, and keeps what it has measured, if the person has not left the step out.
Result<void> do_step(const Options& options, const RunningAs& running, Session& session, Keys& keys,
                     Step step, Measured& measured) {
  auto draft = session.draft();
  const auto outcome = measure_step(options, running, session.folder(), draft, keys, step);
  if (!outcome) return tl::make_unexpected(outcome.error());
  if (!*outcome) return {};
  if (auto kept = session.keep(step, **outcome, draft); !kept) return kept;
  ++measured.steps;
  measured.page = write_page(session.folder());
  return {};
}

/// Measures what is left, or was asked for.
Result<void> measure_steps(const Options& options, const RunningAs& running, Session& session,
                           std::span<const Step> steps, Measured& measured) {
  Keys keys;
  for (const Step step : steps)
    if (auto done = do_step(options, running, session, keys, step, measured); !done)
      return fail_in(config::word_of(step), done.error());
  return {};
}

void tell_page(const Session& session, const Result<void>& page) {
  if (page) return fmt::print("the report is {}\n", session.file("report.html").string());
  fmt::print(stderr, "handcast calibrate: the report was not written: {}\n",
             printable(page.error().what));
}

/// What was measured, now or in an earlier call, gets its place even if a later step has failed.
Result<int> measure_all(const Options& options, const config::Rig& rig, const RunningAs& running,
                        Session& session) {
  const auto steps = steps_of(options, rig, session);
  if (!steps.empty())
    if (auto down = check_down(rig); !down) return tl::make_unexpected(down.error());
  Measured measured;
  const auto done = measure_steps(options, running, session, steps, measured);
  if (measured.steps > 0)
    tell_page(session, measured.page);
  else if (done)
    fmt::print("{}\n", steps.empty() ? "nothing is left to be measured; --restart begins anew"
                                     : "nothing was measured");
  const auto handed_over = hand_over(options, rig, running.calibration, session);
  if (done) return handed_over.map([] { return kExitDone; });
  if (!handed_over) complain(handed_over.error());
  return tl::make_unexpected(done.error());
}

Result<int> print_board(const Options& options) {
  if (auto good = check_result_file(options.board_pdf); !good)
    return tl::make_unexpected(good.error());
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
  if (options.folder == default_folder(options))
    options.folder.replace_extension(devices + ".calibration");
}

Result<int> run(Options options) {
  if (!options.board_pdf.empty()) return print_board(options);
  auto rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto done = [] { return kExitDone; };
  // Also if the calibration cannot be read any more.
  if (options.undo) return undo(options, *rig).map(done);
  const auto named = options.second_projector ? rig->projector2.calibration : rig->calibration;
  if (auto turned = turn_to_projector(*rig, options); !turned)
    return tl::make_unexpected(turned.error());
  rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  if (auto possible = check_steps(options, *rig); !possible)
    return tl::make_unexpected(possible.error());
  // Before anything is forgotten. Without these, nothing may be left to be measured.
  if (options.restart || !options.steps.empty())
    if (auto down = check_down(*rig); !down) return tl::make_unexpected(down.error());
  if (rig->camera.backend != "twin")
    fmt::print(stderr, "looking for the devices of {}\n", printable(options.rig_file.string()));
  const auto own = own_devices(*rig);
  const auto running = rig_as_it_runs(options, *rig, own);
  if (!running) return tl::make_unexpected(running.error());
  if (auto known = check_known(options, *running); !known)
    return tl::make_unexpected(known.error());
  if (!options.points.empty())
    return judge_points(options.points, running->calibration.camera).map(done);
  if (options.correct) return correct_tracker(options, *rig, running->calibration).map(done);
  if (options.check) return check_installed(options, *rig, *running);
  rig->calibration = named;
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
  const auto text = options.map([](const auto& each) { return each.text; });
  if (const auto code = answered("handcast calibrate", text)) return *code;
  daemon::install_stop_signals();
  const auto done = run(std::move(*options));
  return done ? *done : complain(done.error());
}

}  // namespace
}  // namespace handcast::calibrate

int main(int argc, char** argv) {
  return handcast::run_program("handcast calibrate", argc, argv, handcast::calibrate::run_verb);
}
