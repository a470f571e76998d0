// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "config/rig.hpp"
#include "ipc/base/join.hpp"
#include "supervisor/commands/check_rig.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/spec/catalogue.hpp"

namespace handcast::supervisor {
namespace {

Catalogue installed_services() { return read_catalogue(catalogue_folder(program_folder())); }

/// Prints what `up` would refuse about a rig.
int check(const config::Rig& rig, const std::string& file,
          const std::vector<std::string>& settings) {
  const auto faults = faults_of(rig, file, settings);
  if (!faults.empty())
    return complain(kExitConfig, fmt::format("{}:\n{}", file, join(faults, "\n")));
  fmt::print("{} is in order\n", file);
  return kExitDone;
}

}  // namespace

int run_config(const Arguments& arguments) {
  auto line = command_line_of("config");
  std::string file;
  std::vector<std::string> settings;
  bool prints = false, checks = false, explains = false;
  line.add("[FILE]", file, "The rig file");
  line.add("--print", prints, "All settings, with defaults where FILE has none");
  line.add("--check", checks,
           "What `handcast up` would refuse: settings, back ends, and the files that the services "
           "open; devices, outputs and ports are not opened");
  line.add("--reference", explains, "The page config/REFERENCE.md");
  line.add("--set path=value", settings, "A setting that overrides that of the file");
  if (const auto code = line.answered(arguments)) return *code;
  if (explains) {
    fmt::print("{}{}", config::print_reference(), print_backends(installed_services()));
    return kExitDone;
  }
  if (prints == checks) return line.refuse("one of --print, --check, --reference is needed");
  if (checks && file.empty()) return line.refuse("--check needs a file");

  const auto rig =
      file.empty() ? config::parse_rig("", std::filesystem::current_path() / "defaults", settings)
                   : config::load_rig(file, settings);
  if (!rig) return complain(rig.error());
  if (checks) return check(*rig, file, settings);
  fmt::print("{}", config::print_rig(*rig));
  return kExitDone;
}

}  // namespace handcast::supervisor
