// SPDX-License-Identifier: Apache-2.0
#include <exception>

#include "calib/sub_frames.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/program.hpp"
#include "ipc/daemon/check_word.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/options.hpp"
#include "services/runtime/scheduling.hpp"

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

Result<calib::Calibration> load_calibration(const config::Rig& rig) {
  return calib::load_calibration(rig.calibration, rig.projector, rig.projector2);
}

int serve(const Instance& instance, const Options& options) try {
  daemon::install_stop_signals();
  const auto& description = instance.description;
  auto rig = must(config::load_rig(options.config_file, options.settings));
  for (const auto& note :
       must(apply_scheduling(config::process_of(rig, description.name), description.name)))
    log::warning("{}", note);
  auto calibration = must(load_calibration(rig));
  Context context(description, std::move(rig), std::move(calibration));
  instance.body(context);
  log::info("stopped");
  return kExitDone;
} catch (const std::exception& problem) {
  give_up({Errc::unavailable, problem.what()});
}

/// What keeps a service from starting with this rig.
std::vector<Error> find_faults(const config::Rig& rig, const Instance& instance) {
  const auto& name = instance.description.name;
  std::vector<Error> faults;
  const auto note = [&](const Result<void>& result) {
    if (!result) faults.push_back(result.error());
  };
  note(check_scheduling(config::process_of(rig, name), name));
  const auto calibration = load_calibration(rig);
  if (!calibration) faults.push_back(calibration.error());
  if (instance.check) note(instance.check(rig, calibration.value_or(stand_in())));
  return faults;
}

/// Prints the faults, one sentence per line; the last word if there are none.
int examine(const Instance& instance, const Options& options) {
  log::set_level(log::Level::error);
  const auto rig = config::load_rig(options.config_file, options.settings);
  const auto faults = rig ? find_faults(*rig, instance) : std::vector{rig.error()};
  for (const auto& fault : faults) fmt::print("{}\n", printable(fault.what));
  if (faults.empty()) fmt::print("{}", daemon::kCheckedWord);
  return faults.empty() ? kExitDone : exit_code_of(faults.front());
}

}  // namespace

daemon::ServiceDescription describe_at(config::Viewpoint at, daemon::ServiceDescription first) {
  const auto rename = [at](std::vector<std::string>& names) {
    for (auto& name : names) name = config::name_at(at, name);
  };
  if (at == config::Viewpoint::second) first.summary = "Of the second camera: " + first.summary;
  first.name = config::name_at(at, first.name);
  first.paced_by = config::name_at(at, first.paced_by);
  for (auto* names : {&first.publishes, &first.subscribes, &first.settings}) rename(*names);
  for (auto& backend : first.backends) rename(backend.settings);
  return first;
}

int run(std::span<const Instance> instances, int argc, char** argv, std::string_view name) {
  const auto program = name.empty() ? instances.front().description.name : std::string(name);
  log::set_program(program);
  return run_program("handcast-" + program, argc, argv, [&](int count, char** words) {
    const auto options = parse_options(instances, count, words, program);
    if (!options) {
      log::error("{}", options.error().what);
      return kExitUsage;
    }
    if (options->answer) {
      fmt::print("{}", *options->answer);
      return kExitDone;
    }
    const auto& instance = *options->instance;
    log::set_program(instance.description.name);
    return options->check ? examine(instance, *options) : serve(instance, *options);
  });
}

int run(const daemon::ServiceDescription& description, int argc, char** argv,
        const std::function<void(Context&)>& body, const Check& check) {
  const Instance only{description, body, check};
  return run(std::span(&only, 1), argc, argv);
}

}  // namespace handcast::service
