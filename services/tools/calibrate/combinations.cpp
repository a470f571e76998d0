// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/combinations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace handcast::calibrate {
namespace {

/// An option in place of which no step is measured.
struct Task {
  const char* option;
  std::vector<std::string> takes;  ///< the options that it takes, besides the rig file
};

const std::array<Task, 5>& tasks() {
  static const std::array<Task, 5> kTasks{{
      {"--print-board", {"--board"}},
      {"--check", {"--set", "--board", "--most-s", "--yes", "--reflector"}},
      {"--points", {"--set"}},
      {"--correct", {"--set", "--most-s", "--yes"}},
      {"--undo", {"--set"}},
  }};
  return kTasks;
}

/// Of the options that were given, those that begin with --.
std::vector<std::string> given(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* option : app.get_options())
    if (option->count() > 0 && !option->get_lnames().empty())
      names.push_back("--" + option->get_lnames().front());
  return names;
}

bool measures(const Options& options, Step step) {
  return options.steps.empty() || std::ranges::count(options.steps, step) > 0;
}

Result<void> check_task(const Task& task, const std::vector<std::string>& names,
                        const Options& options) {
  for (const auto& name : names) {
    if (name == task.option || std::ranges::count(task.takes, name) > 0) continue;
    const bool is_task =
        std::ranges::any_of(tasks(), [&](const Task& other) { return name == other.option; });
    return fail(Errc::bad_config,
                is_task
                    ? fmt::format("{} and {} do different things; choose one", task.option, name)
                    : fmt::format("{} does not take {}; leave it out", task.option, name));
  }
  if (options.steps.empty()) return {};
  return fail(Errc::bad_config,
              fmt::format("{} measures no single steps; leave them out", task.option));
}

}  // namespace

Result<void> check_combination(const CLI::App& app, const Options& options) {
  const auto names = given(app);
  const auto is_given = [&](const char* name) { return std::ranges::count(names, name) > 0; };
  for (const auto& task : tasks())
    if (is_given(task.option)) return check_task(task, names, options);
  if (options.reflector_mm > 0 && !measures(options, Step::tracker))
    return fail(Errc::bad_config, "--reflector belongs to the step `tracker`; add it");
  if (!options.photodiode.empty() && !measures(options, Step::light))
    return fail(Errc::bad_config, "--photodiode belongs to the step `light`; add it");
  return {};
}

}  // namespace handcast::calibrate
