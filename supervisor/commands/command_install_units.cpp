// SPDX-License-Identifier: Apache-2.0
// `handcast install-units`: writes a systemd unit that runs a rig.
#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <cstdlib>

#include "config/rig.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/control/rig_address.hpp"
#include "supervisor/base/options.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/succession/service_unit.hpp"

namespace handcast::supervisor {
namespace {

/// The user of a system unit: that of --user, else with sudo the user who called it, else this one.
/// Errors: bad_config (there is no such user; it would be root, and --user does not say so).
Result<std::string> user_of(const Options& options) {
  if (!options.has("--system")) return std::string();
  std::string name = options.value("--user");
  if (const char* caller = std::getenv("SUDO_USER"); name.empty() && caller) name = caller;
  const auto* entry = name.empty() ? getpwuid(getuid()) : getpwnam(name.c_str());
  if (!entry)
    return fail(Errc::bad_config, fmt::format("install-units: there is no user '{}'", name));
  if (entry->pw_uid == 0 && !options.has("--user"))
    return fail(Errc::bad_config,
                "install-units: the rig would run as root; --user NAME names another user "
                "(`--user root` if it must be root)");
  return std::string(entry->pw_name);
}

Result<void> write_unit(const std::filesystem::path& file, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  auto written = write_whole(file, text);
  if (!written && getuid() != 0) written.error().what += "; `sudo` may help";
  return written;
}

void print_next_steps(const UnitSpec& spec) {
  const auto* systemctl = spec.system ? "sudo systemctl" : "systemctl --user";
  if (spec.system && !spec.out.empty())
    fmt::print("  sudo install -d -o {} '{}'    # if it is not there yet\n", spec.user,
               printable(spec.out.string()));
  fmt::print("  {} daemon-reload\n", systemctl);
  fmt::print("  {} enable --now {}\n", systemctl, unit_name(spec));
  if (spec.system)
    fmt::print(
        "Commands such as `handcast status` must run as user {0}: `sudo -u {0} handcast status`.\n",
        spec.user);
  else
    fmt::print("  loginctl enable-linger    # to run also while you are not logged in\n");
}

}  // namespace

int run_install_units(const Arguments& arguments) {
  const auto options = sort_options(arguments, {.with_value = {"--set", "--out", "--user"},
                                                .flags = {"--system", "--print"},
                                                .words = {"RIG.toml"}});
  if (!options)
    return complain(kExitUsage,
                    "install-units: " + options.error().what + "; `handcast help install-units`");
  const auto rig_file = std::filesystem::absolute(options->words.front());
  const auto rig = config::load_rig(rig_file, options->all("--set"));
  if (!rig) return complain(rig.error());
  if (const auto named = control::address_of(rig->name); !named) return complain(named.error());

  if (options->has("--user") && !options->has("--system"))
    return complain(kExitUsage, "install-units: --user needs --system");
  auto user = user_of(*options);
  if (!user) return complain(user.error());
  std::filesystem::path out;
  if (options->has("--out")) {
    if (options->value("--out").empty())
      return complain(kExitUsage, "install-units: --out needs the name of a folder");
    out = std::filesystem::absolute(options->value("--out"));
  }
  const UnitSpec spec{.rig = rig->name,
                      .program = program_folder() / "handcast",
                      .rig_file = rig_file,
                      .settings = options->all("--set"),
                      .out = out,
                      .system = options->has("--system"),
                      .user = *user,
                      .groups = device_groups()};
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
