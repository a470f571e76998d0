// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/service_unit.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <map>
#include <sstream>
#include <utility>

#include "ipc/base/join.hpp"
#include "supervisor/succession/units/template.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::string_view kForSystem = "#system#", kForUser = "#user#", kForWindow = "#window#",
                           kForRealTime = "#real-time#", kForTemplate = "#template#";
constexpr const char* kPackagedRigs = "/etc/handcast";  ///< as in scripts/package.d/tmpfiles.conf

/// The groups that own the devices of rigs.
constexpr std::array kDeviceGroups{"video", "render", "input", "plugdev"};

/// Quotes one word of a command line. systemd expands %x and $X, and reads quotes and backslashes
/// as a shell does.
std::string word(const std::string& text) {
  std::string quoted = "\"";
  for (const char character : text) {
    if (character == '"' || character == '\\') quoted += '\\';
    if (character == '%' || character == '$') quoted += character;
    quoted += character;
  }
  return quoted + '"';
}

/// Where the night watch keeps its reports: the unit may not write beside every rig file.
std::string reports_of(const UnitSpec& spec) {
  return fmt::format("--set \"watch.folder=%S/handcast/{}/watch\"", spec.rig);
}

/// The command of all instances. `name`: ExecStop names the rig by its file, whatever is in it.
/// /etc is not for recordings, which are large.
std::string command_of_template(const UnitSpec& spec) {
  return fmt::format(
      "{} up --no-keeper \"{}/%i.toml\" --out \"%L/handcast/%i\" --set \"name=%i\" --set "
      "\"desk.page.recordings=%S/handcast/%i/recordings\" {}",
      word(spec.program), kPackagedRigs, reports_of(spec));
}

std::string command_of(const UnitSpec& spec) {
  if (spec.is_template) return command_of_template(spec);
  const auto out = spec.out.empty() ? fmt::format("\"%S/handcast/{}\"", spec.rig) : word(spec.out);
  auto command = fmt::format("{} up --no-keeper {} {} --out {}", word(spec.program),
                             word(spec.rig_file), reports_of(spec), out);
  for (const auto& setting : spec.settings) command += " --set " + word(setting);
  return command;
}

std::string replaced(std::string line, const std::map<std::string, std::string>& values) {
  for (const auto& [mark, value] : values)
    for (auto at = line.find(mark); at != std::string::npos;
         at = line.find(mark, at + value.size()))
      line.replace(at, mark.size(), value);
  return line;
}

/// Removes a mark at the beginning of a line. Returns false if the line does not have it.
bool take_mark(std::string& line, std::string_view mark) {
  if (!line.starts_with(mark)) return false;
  line.erase(0, line.size() > mark.size() ? mark.size() + 1 : mark.size());
  return true;
}

/// A text between quotes where systemd expands %x but not $X.
std::string plain(const std::string& text) {
  std::string quoted;
  for (const char character : text) {
    if (character == '"' || character == '\\') quoted += '\\';
    if (character == '%') quoted += character;
    quoted += character;
  }
  return quoted;
}

/// A system unit may write only to the folders that it names. '-': if the folder is missing,
/// `handcast up` says so better than systemd. Settings are saved beside the rig file.
std::string writable_folder(const UnitSpec& spec) {
  if (spec.is_template) return fmt::format("ReadWritePaths=\"-{}\"", kPackagedRigs);
  if (spec.out.empty() || !spec.system) return {};
  return fmt::format("ReadWritePaths=\"-{}\"", plain(spec.out.string()));
}

std::string home() {
  if (const char* folder = std::getenv("HOME"); folder && *folder) return folder;
  const auto* entry = getpwuid(getuid());
  return entry ? entry->pw_dir : "/";
}

}  // namespace

std::vector<std::string> device_groups() {
  std::vector<std::string> groups;
  for (const char* name : kDeviceGroups)
    if (getgrnam(name) != nullptr) groups.emplace_back(name);
  return groups;
}

UnitSpec template_spec(std::filesystem::path program) {
  return {.rig = "%i",
          .program = std::move(program),
          .rig_file = {},
          .settings = {},
          .out = {},
          .system = true,
          .is_template = true,
          .user = "handcast",
          .groups = {kDeviceGroups.begin(), kDeviceGroups.end()},
          .real_time = true};
}

std::string unit_name(const UnitSpec& spec) {
  return spec.is_template ? "handcast@.service" : fmt::format("handcast-{}.service", spec.rig);
}

std::string unit_text(const UnitSpec& spec) {
  const std::map<std::string, std::string> values{
      {"@NAME@", spec.rig},
      {"@PROGRAM@", word(spec.program)},
      {"@COMMAND@", command_of(spec)},
      {"@WRITABLE@", writable_folder(spec)},
      {"@GROUPS@", join(spec.groups, " ")},
      {"@USER@", spec.user},
      {"@CAPABILITIES@", spec.real_time ? "CAP_SYS_NICE" : ""},
      {"@DISPLAY@", plain(spec.display)},
      {"@XAUTHORITY@", plain(spec.x_authority)},
      {"@SYSTEM_TARGET@", spec.window ? "graphical.target" : "multi-user.target"},
      {"@USER_TARGET@", spec.window ? "graphical-session.target" : "default.target"}};
  std::istringstream lines{std::string(kServiceTemplate)};
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (take_mark(line, kForWindow) && !spec.window) continue;
    if (take_mark(line, kForSystem) && !spec.system) continue;
    if (take_mark(line, kForUser) && spec.system) continue;
    if (take_mark(line, kForRealTime) && !spec.real_time) continue;
    if (take_mark(line, kForTemplate) && !spec.is_template) continue;
    text += replaced(line, values) + "\n";
  }
  return text;
}

std::filesystem::path unit_folder(const UnitSpec& spec) {
  if (spec.system) return "/etc/systemd/system";
  const char* config = std::getenv("XDG_CONFIG_HOME");
  return std::filesystem::path(config && *config ? config : home() + "/.config") / "systemd/user";
}

}  // namespace handcast::supervisor
