// SPDX-License-Identifier: Apache-2.0
// `handcast install-units`: writes a systemd unit that runs a rig.
#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <cstdlib>

#include "config/rig.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/control/rig_address.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/succession/service_unit.hpp"

namespace handcast::supervisor {
namespace {

/// The user of a system unit: `name` of --user, else with sudo the user who called it, else this
/// one. Errors: bad_config (there is no such user; it would be root, and --user does not say so).
Result<std::string> user_of(std::string name) {
  const bool is_named = !name.empty();
  if (const char* caller = std::getenv("SUDO_USER"); name.empty() && caller) name = caller;
  const auto* entry = name.empty() ? getpwuid(getuid()) : getpwnam(name.c_str());
  if (!entry)
    return fail(Errc::bad_config, fmt::format("install-units: there is no user '{}'", name));
  if (entry->pw_uid == 0 && !is_named)
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

/// What a person must know about a unit whose light is a window.
void print_window_steps(const UnitSpec& spec) {
  if (spec.system)
    fmt::print(
        "The light is a window, so the unit names an X server: DISPLAY={} and XAUTHORITY={}. In "
        "the session of {} that shows it, `echo $DISPLAY $XAUTHORITY` must print the same; "
        "`systemctl edit {}` changes them. A unit without --system takes them from the session.\n",
        printable(spec.display), printable(spec.x_authority), spec.user, unit_name(spec));
  else
    fmt::print(
        "The light is a window, so the unit starts and stops with your graphical session "
        "(graphical-session.target). `systemctl --user show-environment` must list DISPLAY; if it "
        "does not, let the session call `systemctl --user import-environment DISPLAY XAUTHORITY` "
        "at its start. If your desktop has no such target, let it call `systemctl --user start "
        "{}`.\n",
        unit_name(spec));
  fmt::print("`handcast doctor` names what would blank, lock or suspend the computer.\n");
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
  else if (!spec.window)
    fmt::print("  loginctl enable-linger    # to run also while you are not logged in\n");
  if (spec.real_time && !spec.system)
    fmt::print(
        "A service wants a real-time priority, which a user's unit gets only up to the limit of "
        "its manager: `sudo systemctl edit user@{}.service`, and there [Service] and "
        "LimitRTPRIO=90; or use --system.\n",
        getuid());
  if (spec.window) print_window_steps(spec);
}

/// The display that the environment names, or else the usual one of this user.
void take_display(UnitSpec& spec) {
  const char* display = std::getenv("DISPLAY");
  const char* authority = std::getenv("XAUTHORITY");
  const auto* user = getpwnam(spec.user.c_str());
  spec.display = display && *display ? display : ":0";
  spec.x_authority =
      authority && *authority ? authority : std::string(user ? user->pw_dir : "") + "/.Xauthority";
}

int print_template(const std::string& program) {
  fmt::print("{}", unit_text(template_spec(program)));
  return kExitDone;
}

bool wants_real_time(const config::Rig& rig) {
  const auto wants = [&](const std::string& name) { return process_of(rig, name).priority > 0; };
  for (const std::string service : {"camera", "pose", "landmarks", "projector"})
    if (wants(service) || wants(service + "2")) return true;
  return false;
}

}  // namespace

int run_install_units(const Arguments& arguments) {
  auto line = command_line_of("install-units");
  UnitSpec spec{.program = program_folder() / "handcast", .groups = device_groups()};
  bool only_print = false;
  std::string template_of;
  line.add("[RIG.toml]", spec.rig_file, "The rig file");
  line.add("--set path=value", spec.settings, "As for `handcast up`");
  line.add("--out DIR", spec.out,
           "As for `handcast up`; default: a folder of the unit, /var/lib/handcast/NAME with "
           "--system");
  line.add("--system", spec.system, "A unit of the machine instead of one of this user");
  line.add("--user NAME", spec.user, "The user as which it runs; default: the one who calls sudo");
  line.add("--print", only_print, "Prints the unit and writes nothing");
  line.add("--print-template PROGRAM", template_of,
           "Prints handcast@.service, the unit of Debian's package, for this program, and ends");
  if (const auto code = line.answered(arguments)) return *code;
  if (!template_of.empty()) return print_template(template_of);
  if (spec.rig_file.empty()) return line.refuse("RIG.toml is missing");
  spec.rig_file = std::filesystem::absolute(spec.rig_file);
  const auto rig = config::load_rig(spec.rig_file, spec.settings);
  if (!rig) return complain(rig.error());
  if (const auto named = control::address_of(rig->name); !named) return complain(named.error());
  spec.rig = rig->name;
  spec.real_time = wants_real_time(*rig);
  spec.window = rig->projector.backend == "window";

  if (!spec.user.empty() && !spec.system) return line.refuse("--user needs --system");
  if (spec.system) {
    const auto user = user_of(spec.user);
    if (!user) return complain(user.error());
    spec.user = *user;
    take_display(spec);
  }
  if (!spec.out.empty()) spec.out = std::filesystem::absolute(spec.out);
  const auto text = unit_text(spec);
  if (only_print) {
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
