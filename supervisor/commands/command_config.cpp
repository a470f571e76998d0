// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "config/measured.hpp"
#include "config/rig.hpp"
#include "ipc/base/join.hpp"
#include "supervisor/base/options.hpp"
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

/// Prints as comments where values come from that are not those of the rig file.
void print_measured(const std::filesystem::path& rig_file) {
  const auto file = config::measured_file_of(rig_file);
  const auto settings = config::read_measured(file);
  if (!settings || settings->empty()) return;
  fmt::print("# {} sets:\n", file.string());
  for (const auto& [path, value] : *settings) fmt::print("#   {} = {}\n", path, value);
}

}  // namespace

int run_config(const Arguments& arguments) {
  const auto options = sort_options(arguments, {.with_value = {"--set"},
                                                .flags = {"--print", "--check", "--reference"},
                                                .words = {},
                                                .more_words = 1});
  if (!options)
    return complain(kExitUsage, "config: " + options.error().what + "; `handcast help config`");
  if (options->has("--reference")) {
    fmt::print("{}{}", config::print_reference(), print_backends(installed_services()));
    return kExitDone;
  }
  const bool checks = options->has("--check");
  if (options->has("--print") == checks)
    return complain(
        kExitUsage,
        "config: one of --print, --check, --reference is needed; `handcast help config`");
  if (checks && options->words.empty()) return complain(kExitUsage, "config: --check needs a file");

  const auto settings = options->all("--set");
  const auto rig =
      options->words.empty()
          ? config::parse_rig("", std::filesystem::current_path() / "defaults", settings)
          : config::load_rig(options->words.front(), settings);
  if (!rig) return complain(rig.error());
  if (checks) return check(*rig, options->words.front(), settings);
  if (!options->words.empty()) print_measured(options->words.front());
  fmt::print("{}", config::print_rig(*rig));
  return kExitDone;
}

}  // namespace handcast::supervisor
