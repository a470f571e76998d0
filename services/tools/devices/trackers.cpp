// SPDX-License-Identifier: Apache-2.0
#include "services/tools/devices/trackers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "services/pose/leapc/library.hpp"
#include "services/pose/openxr/manifest.hpp"

namespace handcast::devices {
namespace {

namespace fs = std::filesystem;

/// The vendors of Leap Motion and of Ultraleap. The latter makes other devices, too: their names
/// distinguish them.
constexpr std::string_view kLeapMotion = "f182", kUltraleap = "2936";

/// Where the linker finds a library that is named without a folder.
constexpr std::array<std::string_view, 3> kLinkerPlaces{"usr/local/lib", "usr/lib",
                                                        "usr/lib/x86_64-linux-gnu"};

std::string line_of(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

std::optional<UsbTracker> tracker_at(const fs::path& device) {
  const auto vendor = line_of(device / "idVendor"), product = line_of(device / "idProduct");
  if (vendor != kLeapMotion && vendor != kUltraleap) return std::nullopt;
  const bool is_v1 = vendor == kLeapMotion && product == "0003";
  auto name = is_v1 ? "Leap Motion Controller" : line_of(device / "product");
  if (name.empty()) name = "a device of Ultraleap";
  return UsbTracker{.name = fmt::format("{} ({}:{})", name, vendor, product),
                    .port = device.filename(),
                    .is_leap_v1 = is_v1};
}

std::string missing_library() { return "Ultraleap's library is missing; " + leapc_remedy(); }

/// Why the back end `leapc` cannot be used now.
std::string leapc_trouble(const std::optional<std::string>& library, bool has_device) {
  if (!library) return missing_library();
  return has_device ? "" : "no device of Ultraleap is attached";
}

std::vector<Attached> ultraleap(const fs::path& root) {
  const auto library = leapc_library(root);
  const auto devices = usb_trackers(root);
  const std::vector<std::pair<std::string, std::string>> settings{{"pose.backend", "leapc"}};
  std::vector<Attached> entries;
  entries.reserve(devices.size() + 1);
  for (const auto& device : devices)
    entries.push_back({.kind = Kind::tracker,
                       .name = fmt::format("{} at USB {}", device.name, device.port),
                       .about = device.is_leap_v1
                                    ? "its images, without Ultraleap's software: camera.backend = "
                                      "\"leap\""
                                    : "",
                       .settings = settings,
                       .trouble = leapc_trouble(library, true),
                       .names = {"leapc"}});
  if (devices.empty() && library)
    entries.push_back({.kind = Kind::tracker,
                       .name = "Ultraleap's service, " + *library,
                       .about = {},
                       .settings = settings,
                       .trouble = leapc_trouble(library, false),
                       .names = {"leapc"}});
  return entries;
}

std::vector<Attached> openxr() {
  Attached entry{
      .kind = Kind::tracker, .name = {}, .about = {}, .settings = {{"pose.backend", "openxr"}}};
  entry.names = {"openxr"};
  const auto runtime = pose::openxr::find_runtime("");
  if (runtime) {
    entry.name = "OpenXR runtime " + runtime->name;
    entry.about =
        fmt::format("{}; it was not started, so that it may have no hand tracking", runtime->file);
  } else {
    // A computer without a runtime has nothing to report; a broken manifest is.
    const auto places = pose::openxr::active_runtime_places();
    std::error_code unknown;
    if (std::ranges::none_of(places, [&](const auto& file) { return fs::exists(file, unknown); }))
      return {};
    entry.name = "OpenXR runtime";
    entry.trouble = runtime.error().what;
  }
#ifndef HANDCAST_WITH_OPENXR
  if (entry.trouble.empty()) entry.trouble = "this build cannot use it (libopenxr-dev)";
#endif
  return {entry};
}

}  // namespace

std::vector<UsbTracker> usb_trackers(const fs::path& root) {
  std::vector<UsbTracker> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root / "sys/bus/usb/devices", error))
    if (auto tracker = tracker_at(entry.path())) found.push_back(std::move(*tracker));
  std::ranges::sort(found, {}, &UsbTracker::port);
  return found;
}

std::optional<std::string> leapc_library(const fs::path& root) {
  std::error_code error;
  for (const auto place : pose::leapc::kLibraryPlaces) {
    if (place.starts_with('/')) {
      if (fs::exists(root / place.substr(1), error)) return root / place.substr(1);
      continue;
    }
    for (const auto folder : kLinkerPlaces)
      if (fs::exists(root / folder / place, error)) return root / folder / place;
  }
  return std::nullopt;
}

std::string leapc_remedy() { return std::string(pose::leapc::kRemedy); }

std::vector<AbsentTracker> absent_trackers(const fs::path& root) {
  std::vector<AbsentTracker> absent;
  if (ultraleap(root).empty())
    absent.push_back({"leapc", "no device of Ultraleap is attached, and " + missing_library()});
  if (openxr().empty()) absent.push_back({"openxr", pose::openxr::find_runtime("").error().what});
  return absent;
}

std::vector<Attached> trackers(const fs::path& root) {
  auto all = ultraleap(root);
  for (auto& entry : openxr()) all.push_back(std::move(entry));
  return all;
}

}  // namespace handcast::devices
