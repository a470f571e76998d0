// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>

#include "ipc/base/join.hpp"
#include "services/camera/v4l2/device.hpp"

namespace handcast::camera::v4l2 {
namespace {

constexpr std::string_view kRemedy = "set v4l2.device to a path, a name or a bus";

Result<Device> usable(Device device) {
  if (device.identity.fault.empty()) return device;
  return fail(Errc::bad_config,
              fmt::format("{}: {}", describe(device.identity), device.identity.fault));
}

/// What was found among the video devices.
struct Search {
  std::vector<Device> fit;
  std::vector<std::string> listed;  ///< every camera, described
  std::optional<Error> refused;     ///< of one that could not be opened
};

Search search(std::string_view wanted) {
  Search found;
  for (const auto& path : device_paths()) {
    auto device = open_device(path);
    if (!device) {
      if (!found.refused) found.refused = device.error();
      continue;
    }
    const auto& identity = device->identity;
    if (!identity.films) continue;
    found.listed.push_back(describe(identity));
    if (wanted.empty() || wanted == identity.card || wanted == identity.bus)
      found.fit.push_back(std::move(*device));
  }
  if (found.fit.size() > 1)
    std::erase_if(found.fit, [](const Device& device) { return !device.identity.fault.empty(); });
  return found;
}

std::string list_of(const Search& found) {
  auto text = found.listed.empty() ? "no camera is attached"
                                   : "the cameras are " + join(found.listed, ", ");
  if (found.refused) text += "; " + found.refused->what;
  return text;
}

Error refusal(const Search& found, const std::string& wanted) {
  if (found.fit.size() > 1)
    return {Errc::bad_config,
            fmt::format("{}; {}; {}",
                        wanted.empty() ? "several cameras are attached"
                                       : fmt::format("several cameras are called '{}'", wanted),
                        list_of(found), kRemedy)};
  if (found.listed.empty() && found.refused) return *found.refused;
  if (wanted.empty())
    return {Errc::unavailable, "no camera is attached (there is no /dev/videoN that captures)"};
  return {Errc::unavailable,
          fmt::format("there is no camera '{}'; {}; {}", wanted, list_of(found), kRemedy)};
}

}  // namespace

Result<Device> find_device(const std::string& wanted) {
  if (wanted.starts_with('/')) {
    auto device = open_device(wanted);
    return device ? usable(std::move(*device)) : std::move(device);
  }
  auto found = search(wanted);
  if (found.fit.size() == 1) return usable(std::move(found.fit.front()));
  return tl::make_unexpected(refusal(found, wanted));
}

}  // namespace handcast::camera::v4l2
