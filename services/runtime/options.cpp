// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/rig.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/join.hpp"
#include "ipc/daemon/back_end_files.hpp"
#include "ipc/daemon/contract.hpp"
#include "services/runtime/scheduling.hpp"

namespace handcast::service {
namespace {

/// Adds the settings that every daemon reads.
daemon::ServiceDescription complete(daemon::ServiceDescription description) {
  auto& settings = description.settings;
  settings.push_back("calibration");
  if (!description.backends.empty()) settings.push_back(description.name + ".backend");
  if (config::has_process(description.name)) settings.push_back(description.name + ".process");
  return description;
}

/// Adds the back ends that are files of their own.
daemon::ServiceDescription with_files(daemon::ServiceDescription description) {
  auto& rows = description.backends;
  for (const auto& [name, file] : daemon::back_end_files(description.name))
    if (std::ranges::find(rows, name, &daemon::BackendDescription::name) == rows.end())
      rows.push_back({.name = name, .sentence = "From " + file.string()});
  return description;
}

/// Declares --as, which the usage text shows if there is a choice.
void add_as(CommandLine& line, std::span<const Instance> instances, const Instance*& chosen) {
  std::vector<std::string> names;
  for (const auto& instance : instances) names.push_back(instance.description.name);
  const auto choose = [instances, names, &chosen](const std::string& name) -> Result<void> {
    for (const auto& instance : instances)
      if (instance.description.name == name) return chosen = &instance, Result<void>();
    return fail(Errc::bad_config,
                fmt::format("this program is {}, not '{}'", join(names, " or "), name));
  };
  line.add("--as NAME", choose,
           names.size() > 1 ? "The service that it is: " + join(names, ", ") : "");
}

}  // namespace

Result<Options> parse_options(std::span<const Instance> instances, int argc,
                              const char* const* argv, std::string_view program) {
  const auto& first = instances.front().description;
  CommandLine line(fmt::format("handcast-{}", program.empty() ? first.name : program),
                   first.summary,
                   "`handcast up RIG.toml` starts this program together with the rest of the rig "
                   "and hands it its rings.");
  Options options{.instance = &instances.front()};
  bool backends = false, describe = false;
  std::string mark;
  int priority = 0;
  add_as(line, instances, options.instance);
  line.add("--config FILE", options.config_file, "The rig file");
  line.add("--set path=value", options.settings, "A setting that overrides the file's");
  line.add("--check", options.check,
           "Opens what the rig names (files, models, calibration), prints what is wrong, or "
           "'checked', and ends");
  line.add("--backends", backends, "Prints the back ends of this build, one per line");
  line.add("--describe", describe, "Prints its rings, settings and back ends as JSON");
  bool attached = false, untouched = false;
  daemon::Search search;
  if (instances.front().attached) {
    line.add("--attached", attached,
             "Prints the devices that its back ends of lib/handcast find, as JSON");
    line.add("--named NAME", search.name, "With --attached: what a rig file means by NAME");
    line.add("--untouched", untouched, "With --attached: opens none of them");
  }
  line.add(std::string(daemon::kRigOption) + " MARK", mark, "");
  line.add("--try-priority N", priority, "", {1, 99});
  auto text = line.parse(argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  const auto& description = options.instance->description;
  if (!text->empty()) options.answer = std::move(*text);
  if (!options.answer && backends) options.answer = daemon::print_backends(with_files(description));
  if (!options.answer && priority > 0) options.answer = try_priority(priority) + "\n";
  if (!options.answer && describe)
    options.answer = daemon::print_description(complete(description));
  search.opens = !untouched;
  if (!options.answer && attached) options.answer = to_json(instances.front().attached(search));
  if (options.answer || !options.config_file.empty()) return options;
  return fail(Errc::bad_config,
              "--config FILE is missing; `handcast up FILE` starts this program with a whole rig");
}

}  // namespace handcast::service
