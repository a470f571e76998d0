// SPDX-License-Identifier: Apache-2.0
#include "services/tools/devices/attached.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "ipc/daemon/back_end_files.hpp"
#include "services/tools/devices/trackers.hpp"

namespace handcast::devices {
namespace {

/// The settings as they stand in a rig file: a section, and its lines.
std::string print(const std::vector<std::pair<std::string, std::string>>& settings) {
  std::string text, section;
  for (const auto& [setting, value] : settings) {
    const auto dot = setting.find('.');
    if (const auto begun = setting.substr(0, dot); begun != section)
      text += fmt::format("      [{}]\n", section = begun);
    text += fmt::format(
        "      {} = {}\n", setting.substr(dot + 1),
        nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  }
  return text;
}

/// The lines of one device, indented.
std::string print(const Attached& device) {
  auto text = fmt::format("  {}\n", device.name);
  if (!device.about.empty()) text += fmt::format("    {}\n", device.about);
  if (!device.trouble.empty()) text += fmt::format("    cannot be used: {}\n", device.trouble);
  return text + print(device.settings);
}

std::vector<Attached> joined(std::vector<Attached> first, std::vector<Attached> second) {
  std::move(second.begin(), second.end(), std::back_inserter(first));
  return first;
}

}  // namespace

std::vector<Attached> attached_of(Kind kind) {
  if (kind == Kind::camera) return joined(cameras_of_files(), webcams());
  if (kind == Kind::tracker) return trackers();
  return kind == Kind::display ? joined(monitors(), connectors()) : controllers();
}

std::vector<Attached> all_attached() {
  return joined(joined(attached_of(Kind::camera), attached_of(Kind::display)),
                joined(attached_of(Kind::controller), attached_of(Kind::tracker)));
}

std::vector<std::string> blind_spots() {
  std::vector<std::string> spots;
  if (!daemon::back_end_files("camera").contains("aravis"))
    spots.emplace_back(
        "GigE Vision and USB3 Vision cameras (package handcast-aravis, or a build with "
        "libaravis-dev)");
#ifndef HANDCAST_WITH_WINDOW
  spots.emplace_back("monitors of the window system (libglfw3-dev libopengl-dev libxrandr-dev)");
#endif
#ifndef HANDCAST_WITH_KMS
  spots.emplace_back("displays without a window system (libdrm-dev)");
#endif
#ifndef HANDCAST_WITH_HIDAPI
  spots.emplace_back("controllers of DLP projectors (libhidapi-dev)");
#endif
  return spots;
}

std::vector<std::string> missing_trackers() {
  std::vector<std::string> sentences;
  for (const auto& [backend, why] : absent_trackers())
    sentences.push_back(fmt::format("{}: {}", backend, why));
  return sentences;
}

std::string print(const std::vector<Attached>& attached,
                  const std::vector<std::string>& blind_spots,
                  const std::vector<std::string>& missing_trackers) {
  std::string text;
  for (std::size_t kind = 0; kind < kKindNames.size(); ++kind) {
    std::string devices;
    for (const auto& device : attached)
      if (static_cast<std::size_t>(device.kind) == kind) devices += print(device);
    text += fmt::format("{}\n{}", kKindNames[kind], devices.empty() ? "  none\n" : devices);
    if (kind != static_cast<std::size_t>(Kind::tracker)) continue;
    for (const auto& sentence : missing_trackers) text += fmt::format("  without {}\n", sentence);
  }
  for (const auto& spot : blind_spots)
    text += fmt::format("this installation cannot see {}\n", spot);
  return text;
}

}  // namespace handcast::devices
