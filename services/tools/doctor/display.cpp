// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/display.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <string>
#include <string_view>

#include "ipc/base/join.hpp"
#ifdef HANDCAST_WITH_WINDOW
#include "renderer/window/x11.hpp"
#endif

namespace handcast::doctor {
namespace fs = std::filesystem;
namespace {

/// Programs that blank or lock a screen, or suspend the computer, for lack of input, as
/// /proc/PID/comm has them: at most 15 characters.
constexpr std::array<std::string_view, 19> kIdlePrograms{
    "cinnamon-screen", "gnome-screensav", "gsd-power",    "gsd-screensaver", "hypridle",
    "i3lock",          "kscreenlocker_g", "light-locker", "mate-power-mana", "mate-screensave",
    "org_kde_powerde", "swayidle",        "xautolock",    "xfce4-power-man", "xfce4-screensav",
    "xidlehook",       "xscreensaver",    "xss-lock",     "ukui-screensave"};

std::vector<fs::path> entries_in(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (auto entry = fs::directory_iterator(folder, error);
       !error && entry != fs::directory_iterator(); entry.increment(error))
    entries.push_back(entry->path());
  std::ranges::sort(entries);
  return entries;
}

Finding idle_programs(const fs::path& root) {
  std::set<std::string> running;
  for (const auto& process : entries_in(root / "proc")) {
    std::ifstream file(process / "comm");
    std::string name;
    if (std::getline(file, name) && std::ranges::find(kIdlePrograms, name) != kIdlePrograms.end())
      running.insert(name);
  }
  if (running.empty())
    return {"idle", Grade::good, "no program is known here that locks an idle screen", ""};
  return {"idle", Grade::advice,
          fmt::format("{}: may blank, lock or suspend after some minutes without a key; the "
                      "projector asks the desktop not to, but not every program listens",
                      join(running, ", ")),
          "switch blanking, locking and automatic suspend off in the settings of the desktop"};
}

/// The last value of a setting of systemd-logind; "" if it has its default.
std::string logind_setting(const fs::path& root, std::string_view name) {
  auto files = entries_in(root / "etc/systemd/logind.conf.d");
  files.insert(files.begin(), root / "etc/systemd/logind.conf");
  std::string value;
  for (const auto& each : files) {
    std::ifstream file(each);
    for (std::string line; std::getline(file, line);)
      if (line.starts_with(name) && line.substr(name.size()).starts_with('='))
        value = line.substr(name.size() + 1);
  }
  return value;
}

Finding suspend(const fs::path& root) {
  const auto action = logind_setting(root, "IdleAction");
  const bool has_lid = !entries_in(root / "proc/acpi/button/lid").empty();
  const auto lid = logind_setting(root, "HandleLidSwitch");
  std::vector<std::string> reasons;
  if (!action.empty() && action != "ignore")
    reasons.push_back(
        fmt::format("systemd-logind does '{}' when nobody has pressed a key for a "
                    "while (IdleAction)",
                    action));
  if (has_lid && lid != "ignore")
    reasons.push_back(
        fmt::format("a closed lid means '{}' (HandleLidSwitch)", lid.empty() ? "suspend" : lid));
  if (reasons.empty()) return {"suspend", Grade::good, "systemd-logind leaves it awake", ""};
  return {"suspend", Grade::advice, join(reasons, "; "),
          "write [Login], IdleAction=ignore and HandleLidSwitch=ignore to "
          "/etc/systemd/logind.conf.d/handcast.conf and restart the computer"};
}

#ifdef HANDCAST_WITH_WINDOW
std::string after(std::string_view what, int seconds) {
  return seconds > 0 ? fmt::format("{} after {} s", what, seconds) : std::string();
}

Finding x_server() {
  const auto waits = renderer::x11::blanking();
  if (!waits)
    return {"display", Grade::advice, "no X server answers here, so its timers are not known",
            "call the doctor in the session that shows the window, or set DISPLAY and XAUTHORITY"};
  std::vector<std::string> timers;
  for (auto& timer :
       {after("blanks", waits->saver_s), after("switches the monitor off", waits->power_s)})
    if (!timer.empty()) timers.push_back(timer);
  if (timers.empty()) return {"display", Grade::good, "the X server does not blank it", ""};
  return {"display", Grade::good,
          fmt::format("the X server {}; the window suspends that while it is open",
                      join(timers, " and ")),
          ""};
}
#endif

}  // namespace

std::vector<Finding> examine_display(const config::Rig& rig, const fs::path& root) {
  if (rig.projector.backend != "window") return {};
  std::vector<Finding> findings{idle_programs(root), suspend(root)};
#ifdef HANDCAST_WITH_WINDOW
  findings.push_back(x_server());
#endif
  return findings;
}

}  // namespace handcast::doctor
