// SPDX-License-Identifier: Apache-2.0
#include <exception>

#include "calib/sub_frames.hpp"
#include "config/second_view.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/wording.hpp"
#include "ipc/daemon/check_word.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/options.hpp"
#include "services/runtime/scheduling.hpp"
#include "services/runtime/second_view.hpp"

namespace handcast::service {
namespace {

/// Stands for a calibration that cannot be loaded, so that the rest of the rig can be checked. It
/// has two cameras.
calib::Calibration stand_in() {
  auto calibration = calib::reference_rig();
  glm::dmat4 beside(1);
  beside[3] = {0.1, 0, 0, 1};
  calibration.camera2 = calib::SecondCamera{{}, calibration.camera, beside};
  return calibration;
}

/// The calibration as this service has it. Errors: those of calib::load_calibration(); bad_config
/// (a service of the second view, and there is no second camera).
Result<calib::Calibration> load_calibration(const config::Rig& rig,
                                            const daemon::ServiceDescription& description) {
  auto calibration = calib::load_calibration(rig.calibration, rig.projector.packing);
  if (!calibration || !description.is_second_view) return calibration;
  if (calibration->camera2) return calib::second_view(*calibration);
  return fail(
      Errc::bad_config,
      "the calibration has no second camera ([camera2], [camera2_from_camera]); measure it with "
      "`handcast calibrate`");
}

int serve(const daemon::ServiceDescription& description, const Options& options,
          const std::function<void(Context&)>& body) try {
  daemon::install_stop_signals();
  auto rig = must(config::load_rig(options.config_file, options.settings));
  for (const auto& note :
       must(apply_scheduling(config::process_of(rig, description.name), description.name)))
    log::warning("{}", note);
  auto calibration = must(load_calibration(rig, description));
  if (description.is_second_view) {
    rig = config::seen_by_second(std::move(rig));
    log::set_wording(in_second_view);
  }
  Context context(description, std::move(rig), calibration);
  body(context);
  log::info("stopped");
  return kExitDone;
} catch (const std::exception& problem) {
  give_up({Errc::unavailable, problem.what()});
}

/// What keeps a service from starting with this rig.
std::vector<Error> find_faults(const config::Rig& rig,
                               const daemon::ServiceDescription& description, const Check& check) {
  std::vector<Error> faults;
  const auto note = [&](const Result<void>& result) {
    if (!result) faults.push_back(result.error());
  };
  note(check_scheduling(config::process_of(rig, description.name), description.name));
  const auto calibration = load_calibration(rig, description);
  if (!calibration) faults.push_back(calibration.error());
  const auto seen = description.is_second_view ? config::seen_by_second(rig) : rig;
  if (!check) return faults;
  auto checked = check(seen, calibration.value_or(stand_in()));
  if (!checked && description.is_second_view)
    checked = fail(checked.error().code, in_second_view(checked.error().what));
  note(checked);
  return faults;
}

/// Prints the faults, one sentence per line; the last word if there are none.
int examine(const daemon::ServiceDescription& description, const Options& options,
            const Check& check) {
  log::set_level(log::Level::error);
  const auto rig = config::load_rig(options.config_file, options.settings);
  const auto faults = rig ? find_faults(*rig, description, check) : std::vector{rig.error()};
  for (const auto& fault : faults) fmt::print("{}\n", printable(fault.what));
  if (faults.empty()) fmt::print("{}", daemon::kCheckedWord);
  return faults.empty() ? kExitDone : exit_code_of(faults.front());
}

}  // namespace

int run(const daemon::ServiceDescription& description, int argc, char** argv,
        const std::function<void(Context&)>& body, const Check& check) {
  log::set_program(description.name);
  return run_program("handcast-" + description.name, argc, argv, [&](int count, char** words) {
    const auto options = parse_options(description, count, words);
    if (!options) {
      log::error("{}", options.error().what);
      return kExitUsage;
    }
    if (options->answer) {
      fmt::print("{}", *options->answer);
      return kExitDone;
    }
    return options->check ? examine(description, *options, check)
                          : serve(description, *options, body);
  });
}

}  // namespace handcast::service
