// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "config/rig.hpp"
#include "config/settings/settings.hpp"
#include "supervisor/base/options.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/spec/fingerprint.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {
namespace {

Catalogue installed_services() { return read_catalogue(catalogue_folder(program_folder())); }

/// A line for each back end that this installation does not have.
std::string unknown_backends(const config::Rig& rig, const Catalogue& catalogue) {
  std::string lines;
  for (const auto& service : services_of(rig, catalogue)) {
    if (service.backend.empty()) continue;
    if (const auto known = check_backend(catalogue, service.name, service.backend); !known)
      lines += fmt::format("{}.backend: {}\n", service.name, known.error().what);
  }
  return lines;
}

/// A line for each file and folder that is missing although a service of this rig reads it.
std::string missing_files(config::Rig rig, const Catalogue& catalogue) {
  constexpr std::string_view kPlaces[] = {"calibration",
                                          "hand.left",
                                          "hand.right",
                                          "content.left",
                                          "content.right",
                                          "twin.motion",
                                          "camera.replay.directory",
                                          "pose.replay.directory",
                                          "landmarks.replay.directory"};
  std::string lines;
  const auto services = services_of(rig, catalogue);
  const auto listing = config::list_settings(rig);
  for (const auto path : kPlaces) {
    const auto& file = *std::get<std::string*>(config::find_setting(listing, path)->target);
    std::error_code unknown;
    const bool is_read = std::ranges::any_of(services, [&](const ServiceSpec& service) {
      return reads_setting(service.name, rig, catalogue, path);
    });
    if (is_read && !file.empty() && !file.starts_with("builtin:") &&
        !std::filesystem::exists(file, unknown))
      lines += fmt::format("{}: {} does not exist\n", path, file);
  }
  return lines;
}

/// Checks what the settings of a rig refer to. Prints what is wrong.
int check(const config::Rig& rig, const std::string& file) {
  const auto catalogue = installed_services();
  const auto faults = unknown_backends(rig, catalogue) + missing_files(rig, catalogue);
  if (!faults.empty())
    return complain(kExitConfig, fmt::format("{}:\n{}", file, faults.substr(0, faults.size() - 1)));
  fmt::print("{} is in order\n", file);
  return kExitDone;
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
  if (checks) return check(*rig, options->words.front());
  fmt::print("{}", config::print_rig(*rig));
  return kExitDone;
}

}  // namespace handcast::supervisor
