// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>

#include "calib/sub_frames.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/version.hpp"
#include "ipc/daemon/check_word.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "services/runtime/command_line.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/scheduling.hpp"

namespace handcast::service {
namespace {

std::vector<std::string> names_of(std::span<const Instance> instances) {
  std::vector<std::string> names;
  for (const auto& instance : instances) names.push_back(instance.description.name);
  return names;
}

void print_help(std::span<const Instance> instances) {
  const auto& first = instances.front().description;
  const bool has_others = instances.size() > 1;
  fmt::print(
      "handcast-{} — {}\n\n"
      "usage: handcast-{}{} --config RIG.toml [--set path=value]...\n\n"
      "{}"
      "  --config FILE      the rig file\n"
      "  --set path=value   a setting that overrides that of the file; may be repeated\n"
      "  --check            opens what the rig names (files, models, calibration), prints what is\n"
      "                     wrong, or 'checked', and ends\n"
      "  --backends         prints the back ends of this build, one per line\n"
      "  --describe         prints its rings, settings and back ends as JSON\n"
      "  --version, --help\n\n"
      "`handcast up RIG.toml` starts this program together with the rest of the rig and hands it "
      "its rings.\n",
      first.name, first.summary, first.name, has_others ? " [--as NAME]" : "",
      has_others ? fmt::format("  --as NAME          the service that it is: {}\n",
                               join(names_of(instances), ", "))
                 : "");
}

void print_answer(std::span<const Instance> instances, const Instance& asked,
                  CommandLine::Task task) {
  using Task = CommandLine::Task;
  const auto& description = asked.description;
  if (task == Task::help) print_help(instances);
  if (task == Task::version)
    fmt::print("handcast-{} {}\n", instances.front().description.name, version());
  if (task == Task::backends) fmt::print("{}", daemon::print_backends(description));
  if (task == Task::describe) fmt::print("{}", daemon::print_description(complete(description)));
}

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
  return calib::load_calibration(rig.calibration, rig.projector.packing);
}

int serve(const Instance& instance, const CommandLine& line) try {
  daemon::install_stop_signals();
  const auto& description = instance.description;
  auto rig = must(config::load_rig(line.config_file, line.settings));
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
int examine(const Instance& instance, const CommandLine& line) {
  log::set_level(log::Level::error);
  const auto rig = config::load_rig(line.config_file, line.settings);
  const auto faults = rig ? find_faults(*rig, instance) : std::vector{rig.error()};
  for (const auto& fault : faults) fmt::print("{}\n", printable(fault.what));
  if (faults.empty()) fmt::print("{}", daemon::kCheckedWord);
  return faults.empty() ? kExitDone : exit_code_of(faults.front());
}

}  // namespace

daemon::ServiceDescription complete(daemon::ServiceDescription description) {
  auto& settings = description.settings;
  settings.push_back("calibration");
  if (!description.backends.empty()) settings.push_back(description.name + ".backend");
  settings.push_back(description.name + ".process");
  return description;
}

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

int run(std::span<const Instance> instances, int argc, char** argv) {
  const auto& program = instances.front().description.name;
  log::set_program(program);
  return run_program("handcast-" + program, argc, argv, [&](int count, char** words) {
    const auto line = parse_command_line(count, words);
    if (!line) {
      log::error("{}", line.error().what);
      return kExitUsage;
    }
    const auto& name = line->instance.empty() ? program : line->instance;
    const auto instance = std::ranges::find(
        instances, name, [](const Instance& each) { return each.description.name; });
    if (instance == instances.end()) {
      log::error("--as {}: this program is {}", name, join(names_of(instances), " or "));
      return kExitUsage;
    }
    log::set_program(name);
    if (line->task == CommandLine::Task::serve) return serve(*instance, *line);
    if (line->task == CommandLine::Task::check) return examine(*instance, *line);
    print_answer(instances, *instance, line->task);
    return kExitDone;
  });
}

int run(const daemon::ServiceDescription& description, int argc, char** argv,
        const std::function<void(Context&)>& body, const Check& check) {
  const Instance only{description, body, check};
  return run(std::span(&only, 1), argc, argv);
}

}  // namespace handcast::service
