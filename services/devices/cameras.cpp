// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "services/camera/v4l2/list.hpp"
#include "services/devices/attached.hpp"
#ifdef HANDCAST_WITH_ARAVIS
#include "services/camera/aravis/device.hpp"
#endif

namespace handcast::devices {

#ifdef HANDCAST_WITH_ARAVIS
std::vector<Attached> industrial_cameras() {
  using namespace camera;
  std::vector<Attached> attached;
  for (const auto& device : aravis::list_devices()) {
    Attached entry{
        .kind = Kind::camera,
        .name = fmt::format("{} {}, serial number {}", device.vendor, device.model, device.serial),
        .about = fmt::format("{} at {}", device.protocol, device.address),
        .settings = {{"camera.backend", "aravis"}, {"camera.aravis.device", device.serial}},
        .trouble = {}};
    if (const auto opened = aravis::open_device(device); !opened)
      entry.trouble = opened.error().what;
    attached.push_back(std::move(entry));
  }
  return attached;
}
#else
std::vector<Attached> industrial_cameras() { return {}; }
#endif

std::vector<Attached> webcams() {
  std::vector<Attached> attached;
  for (const auto& found : camera::v4l2::list_cameras()) {
    const auto& identity = found.identity;
    attached.push_back(
        {.kind = Kind::camera,
         .name = identity.card.empty() ? identity.path : camera::v4l2::describe(identity),
         .about = camera::v4l2::describe(found.formats),
         .settings = {{"camera.backend", "v4l2"}, {"camera.v4l2.device", identity.path}},
         .trouble = found.trouble});
  }
  return attached;
}

}  // namespace handcast::devices
