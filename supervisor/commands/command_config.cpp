// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "config/rig.hpp"
#include "supervisor/base/options.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {

namespace {

Catalogue installed_services() { return read_catalogue(catalogue_folder(program_folder())); }

/// Whether this installation has the back ends that a rig asks for.
Result<void> check_backends(const config::Rig& rig) {
  const auto catalogue = installed_services();
  for (const auto& service : services_of(rig, catalogue)) {
    if (service.backend.empty()) continue;
    if (auto known = check_backend(catalogue, service.name, service.backend); !known) return known;
  }
  return {};
}

}  // namespace

int run_config(const Arguments& arguments) {
  const auto options = sort_options(arguments, {.with_value = {"--set"},
                                                .flags = {"--print", "--check", "--reference"},
                                                .least_words = 0,
                                                .most_words = 1});
  if (!options)
    return complain(kExitUsage, "config: " + options.error().what + "; `handcast help config`");
  if (options->has("--reference")) {
    fmt::print("{}{}", config::print_reference(), print_backends(installed_services()));
    return kExitDone;
  }
  const bool print = options->has("--print"), check = options->has("--check");
  if (print == check)
    return complain(
        kExitUsage,
        "config: one of --print, --check, --reference is needed; `handcast help config`");
  if (check && options->words.empty()) return complain(kExitUsage, "config: --check needs a file");

  const auto settings = options->all("--set");
  const auto rig =
      options->words.empty()
          ? config::parse_rig("", std::filesystem::current_path() / "defaults", settings)
          : config::load_rig(options->words.front(), settings);
  if (!rig) return complain(rig.error());
  if (check)
    if (const auto known = check_backends(*rig); !known) return complain(known.error());
  fmt::print("{}", print ? config::print_rig(*rig) : options->words.front() + " is in order\n");
  return kExitDone;
}

}  // namespace handcast::supervisor
