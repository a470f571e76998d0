// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/exposure.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "services/camera/v4l2/controls.hpp"

namespace handcast::camera::v4l2 {
namespace {

constexpr std::int64_t kUnit_ns = 100'000;  // of V4L2_CID_EXPOSURE_ABSOLUTE

/// The modes in which the camera keeps the time that was set.
bool keeps_time(std::int64_t mode) {
  return mode == V4L2_EXPOSURE_MANUAL || mode == V4L2_EXPOSURE_SHUTTER_PRIORITY;
}

/// Turns the automatic exposure off. A camera without one needs nothing.
Result<void> set_manual(const Device& device) {
  const auto control = find_control(device.fd.get(), V4L2_CID_EXPOSURE_AUTO);
  if (!control || control->is_read_only) return {};
  for (const std::int64_t mode : {V4L2_EXPOSURE_MANUAL, V4L2_EXPOSURE_SHUTTER_PRIORITY}) {
    if (std::ranges::find(control->menu, mode, &MenuItem::index) == control->menu.end()) continue;
    const auto held = write_control(device, *control, mode);
    return held ? Result<void>() : tl::make_unexpected(held.error());
  }
  return {};
}

double to_ms(std::int64_t units) { return ns_to_ms(units * kUnit_ns); }

}  // namespace

Result<void> set_exposure(const Device& device, double exposure_ms) {
  if (auto manual = set_manual(device); !manual) return manual;
  const auto control = find_control(device.fd.get(), V4L2_CID_EXPOSURE_ABSOLUTE);
  if (!control || control->is_read_only || control->is_inactive) {
    log::warning(
        "{} does not let programs set its exposure; {:g} ms (exposure_ms) "
        "are assumed",
        describe(device.identity), exposure_ms);
    return {};
  }
  const std::int64_t units = std::llround(exposure_ms * 1e6 / kUnit_ns);
  if (units < control->least || units > control->most)
    return fail(Errc::bad_config,
                fmt::format("{} cannot expose for {:g} ms (exposure_ms); it can for {:g} to "
                            "{:g} ms",
                            describe(device.identity), exposure_ms, to_ms(control->least),
                            to_ms(control->most)));
  const auto held = write_control(device, *control, on_step(*control, units));
  if (!held) return tl::make_unexpected(held.error());
  if (*held != units)
    log::info("exposes for {:g} ms instead of {:g} ms", to_ms(*held), exposure_ms);
  return {};
}

Exposure held_exposure(int fd, double exposure_ms) {
  const std::int64_t asked_ns = ms_to_ns(exposure_ms);
  const auto mode = find_control(fd, V4L2_CID_EXPOSURE_AUTO);
  const auto control = find_control(fd, V4L2_CID_EXPOSURE_ABSOLUTE);
  if (!control || control->is_inactive) return {asked_ns, asked_ns};
  if (mode && !keeps_time(read_control(fd, *mode).value_or(V4L2_EXPOSURE_AUTO)))
    return {asked_ns, asked_ns};
  const auto units = read_control(fd, *control);
  if (!units || *units <= 0 || *units > 100'000) return {asked_ns, asked_ns};
  return {*units * kUnit_ns, kUnit_ns / 2};
}

}  // namespace handcast::camera::v4l2
