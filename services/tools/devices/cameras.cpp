// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "services/camera/v4l2/format.hpp"
#include "services/camera/v4l2/list.hpp"
#include "services/tools/devices/attached.hpp"
#ifdef HANDCAST_WITH_ARAVIS
#include "services/camera/aravis/device.hpp"
#endif

namespace handcast::devices {

#ifdef HANDCAST_WITH_ARAVIS
namespace {

/// Names without the empty ones.
std::vector<std::string> known(const std::array<std::string, 4>& names) {
  std::vector<std::string> those(names.begin(), names.end());
  std::erase(those, "");
  return those;
}

/// Opens the camera, to see whether that is possible and what it can do.
void look_into(const camera::aravis::Device& device, Attached& entry) {
  const auto opened = camera::aravis::open_device(device);
  if (!opened) {
    entry.trouble = opened.error().what;
    return;
  }
  const auto sensor = camera::aravis::sensor_of(opened->get());
  if (!sensor) return;
  entry.modes.push_back({.format = "",
                         .least_width_px = sensor->least_width_px,
                         .least_height_px = sensor->least_height_px,
                         .width_px = sensor->width_px,
                         .height_px = sensor->height_px,
                         .rate_hz = sensor->rate_hz});
}

}  // namespace

std::vector<Attached> industrial_cameras() {
  using namespace camera;
  std::vector<Attached> attached;
  for (const auto& device : aravis::list_devices()) {
    Attached entry{
        .kind = Kind::camera,
        .name = fmt::format("{} {}, serial number {}", device.vendor, device.model, device.serial),
        .about = fmt::format("{} at {}", device.protocol, device.address),
        .settings = {{"camera.backend", "aravis"}, {"camera.aravis.device", device.serial}},
        .names = known(aravis::names_of(device))};
    look_into(device, entry);
    attached.push_back(std::move(entry));
  }
  return attached;
}
#else
std::vector<Attached> industrial_cameras() { return {}; }
#endif

namespace {

std::vector<Mode> modes_of(const std::vector<camera::v4l2::FormatSizes>& formats) {
  std::vector<Mode> modes;
  for (const auto preferred : camera::v4l2::kFormats)
    for (const auto& format : formats) {
      if (format.code != camera::v4l2::code_of(preferred)) continue;
      for (const auto& sizes : format.sizes)
        modes.push_back({.format = format.name,
                         .least_width_px = sizes.least.width_px,
                         .least_height_px = sizes.least.height_px,
                         .width_px = sizes.most.width_px,
                         .height_px = sizes.most.height_px,
                         .rate_hz = sizes.rate_hz});
    }
  return modes;
}

}  // namespace

std::vector<Attached> webcams() {
  std::vector<Attached> attached;
  for (const auto& found : camera::v4l2::list_cameras()) {
    const auto& identity = found.identity;
    attached.push_back(
        {.kind = Kind::camera,
         .name = identity.card.empty() ? identity.path : camera::v4l2::describe(identity),
         .about = camera::v4l2::describe(found.formats),
         .settings = {{"camera.backend", "v4l2"}, {"camera.v4l2.device", identity.path}},
         .trouble = found.trouble,
         .names = identity.card.empty() ? std::vector{identity.path}
                                        : std::vector{identity.card, identity.bus, identity.path},
         .modes = modes_of(found.formats)});
  }
  return attached;
}

}  // namespace handcast::devices
