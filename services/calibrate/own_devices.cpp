// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/own_devices.hpp"

#include <algorithm>
#include <cctype>

namespace handcast::calibrate {
namespace {

/// A device as a rig file asks for it.
struct Wanted {
  std::pair<std::string, std::string> backend;  ///< the setting and its value
  std::string name;                             ///< empty: whichever fits
};

Wanted camera_of(const config::Rig& rig) {
  const auto& camera = rig.camera;
  Wanted wanted{{"camera.backend", camera.backend}, {}};
  if (camera.backend == "aravis") wanted.name = camera.aravis.device;
  if (camera.backend == "v4l2") wanted.name = camera.v4l2.device;
  return wanted;
}

Wanted projector_of(const config::Rig& rig) {
  const auto& projector = rig.projector;
  Wanted wanted{{"projector.backend", projector.backend}, {}};
  if (projector.backend == "kms") wanted.name = projector.kms.connector;
  if (projector.backend == "window") wanted.name = projector.window.monitor;
  return wanted;
}

/// A number or a file says where a device is now, and not which one it is.
bool is_lasting(const std::string& name) {
  return !name.starts_with("/dev/") &&
         !std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// The most telling name of the only device that fits.
std::string name_of(const Wanted& wanted, const std::vector<devices::Attached>& attached) {
  std::vector<const devices::Attached*> fitting;
  for (const auto& device : attached)
    if (!device.names.empty() &&
        std::ranges::find(device.settings, wanted.backend) != device.settings.end() &&
        (wanted.name.empty() || std::ranges::count(device.names, wanted.name) > 0))
      fitting.push_back(&device);
  if (fitting.size() == 1) return fitting.front()->names.front();
  return is_lasting(wanted.name) ? wanted.name : "";
}

bool is_device(const std::string& backend) {
  return backend == "aravis" || backend == "v4l2" || backend == "kms" || backend == "window";
}

}  // namespace

OwnDevices own_devices(const config::Rig& rig, const std::vector<devices::Attached>& attached) {
  return {name_of(camera_of(rig), attached), name_of(projector_of(rig), attached)};
}

OwnDevices own_devices(const config::Rig& rig) {
  std::vector<devices::Attached> attached;
  const auto look_for = [&](devices::Kind kind, const std::string& backend) {
    if (!is_device(backend)) return;
    for (auto& device : devices::attached_of(kind)) attached.push_back(std::move(device));
  };
  look_for(devices::Kind::camera, rig.camera.backend);
  look_for(devices::Kind::display, rig.projector.backend);
  return own_devices(rig, attached);
}

}  // namespace handcast::calibrate
