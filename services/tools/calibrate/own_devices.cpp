// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/own_devices.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

namespace handcast::calibrate {
namespace {

/// A device as a rig file asks for it.
struct Wanted {
  std::pair<std::string, std::string> backend;  ///< the setting and its value
  std::string name;                             ///< empty: whichever fits
};

/// Nothing if the back end has no devices.
std::optional<Wanted> camera_of(const config::Camera& camera) {
  const auto named = [&](const std::string& name) {
    return Wanted{{"camera.backend", camera.backend}, name};
  };
  if (camera.backend == "aravis") return named(camera.aravis.device);
  if (camera.backend == "v4l2") return named(camera.v4l2.device);
  return {};
}

std::optional<Wanted> projector_of(const config::Projector& projector) {
  const auto named = [&](const std::string& name) {
    return Wanted{{"projector.backend", projector.backend}, name};
  };
  if (projector.backend == "kms") return named(projector.kms.connector);
  if (projector.backend == "window") return named(projector.window.monitor);
  return {};
}

/// A number or a file says where a device is now, and not which one it is.
bool is_lasting(const std::string& name) {
  return !name.starts_with("/dev/") &&
         !std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// The only device that fits; null if there are several or none.
const devices::Attached* only_fitting(const Wanted& wanted,
                                      const std::vector<devices::Attached>& attached) {
  std::vector<const devices::Attached*> fitting;
  for (const auto& device : attached)
    if (!device.names.empty() &&
        std::ranges::find(device.settings, wanted.backend) != device.settings.end() &&
        (wanted.name.empty() || std::ranges::count(device.names, wanted.name) > 0))
      fitting.push_back(&device);
  return fitting.size() == 1 ? fitting.front() : nullptr;
}

/// Sets the most telling name of a device, and all of its names.
void name_device(const std::optional<Wanted>& wanted,
                 const std::vector<devices::Attached>& attached, std::string& name,
                 std::vector<std::string>& names) {
  if (!wanted) return;
  if (const auto* device = only_fitting(*wanted, attached)) {
    name = device->names.front();
    names.assign(device->names.begin(), device->names.end());
  } else if (is_lasting(wanted->name)) {
    name = wanted->name;
  }
}

}  // namespace

OwnDevices own_devices(const config::Rig& rig, const std::vector<devices::Attached>& attached) {
  OwnDevices own;
  name_device(camera_of(rig.camera), attached, own.camera, own.camera_names);
  name_device(camera_of(rig.camera2), attached, own.camera2, own.camera2_names);
  name_device(projector_of(rig.projector), attached, own.projector, own.projector_names);
  return own;
}

OwnDevices own_devices(const config::Rig& rig) {
  std::vector<devices::Attached> attached;
  const auto look_for = [&](devices::Kind kind) {
    for (auto& device : devices::attached_of(kind)) attached.push_back(std::move(device));
  };
  if (camera_of(rig.camera) || camera_of(rig.camera2)) look_for(devices::Kind::camera);
  if (projector_of(rig.projector)) look_for(devices::Kind::display);
  return own_devices(rig, attached);
}

}  // namespace handcast::calibrate
