// SPDX-License-Identifier: Apache-2.0
// `handcast install-units`: writes a systemd unit that runs a rig.
#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "config/rig.hpp"
#include "ipc/control/rig_address.hpp"
#include "supervisor/base/options.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/succession/service_unit.hpp"

namespace handcast::supervisor {
namespace {

/// The user of a system unit: with sudo, the user who called it.
std::string user_name() {
  const char* before_sudo = std::getenv("SUDO_USER");
  const auto* entry = getpwuid(getuid());
  return before_sudo && *before_sudo ? before_sudo
         : entry                     ? entry->pw_name
                                     : std::to_string(getuid());
}

Result<void> write_unit(const std::filesystem::path& file, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  std::ofstream out(file, std::ios::trunc);
  out << text;
  out.close();
  if (!out)
    return fail(Errc::unavailable, fmt::format("{} cannot be written{}", file.string(),
                                               getuid() == 0 ? "" : "; `sudo` may help"));
  return {};
}

void print_next_steps(const UnitSpec& spec) {
  const auto* systemctl = spec.system ? "sudo systemctl" : "systemctl --user";
  fmt::print("  {} daemon-reload\n", systemctl);
  fmt::print("  {} enable --now {}\n", systemctl, unit_name(spec));
  if (spec.system)
    fmt::print(
        "To use `handcast status` and the like, set XDG_RUNTIME_DIR=/run/handcast and be user "
        "{}.\n",
        spec.user);
  else
    fmt::print("  loginctl enable-linger    # to run also while you are not logged in\n");
}

}  // namespace

int run_install_units(const Arguments& arguments) {
  const auto options = sort_options(arguments, {.with_value = {"--set"},
                                                .flags = {"--system", "--print"},
                                                .least_words = 1,
                                                .most_words = 1});
  if (!options)
    return complain(kExitUsage,
                    "install-units: " + options.error().what + "; `handcast help install-units`");
  const auto rig_file = std::filesystem::absolute(options->words.front());
  const auto rig = config::load_rig(rig_file, options->all("--set"));
  if (!rig) return complain(rig.error());
  if (const auto named = control::address_of(rig->name); !named) return complain(named.error());

  const UnitSpec spec{.rig = rig->name,
                      .program = program_folder() / "handcast",
                      .rig_file = rig_file,
                      .settings = options->all("--set"),
                      .system = options->has("--system"),
                      .user = user_name()};
  const auto text = unit_text(spec);
  if (options->has("--print")) {
    fmt::print("{}", text);
    return kExitDone;
  }
  const auto file = unit_folder(spec) / unit_name(spec);
  if (const auto written = write_unit(file, text); !written) return complain(written.error());
  fmt::print("wrote {}; next steps:\n", file.string());
  print_next_steps(spec);
  return kExitDone;
}

}  // namespace handcast::supervisor
