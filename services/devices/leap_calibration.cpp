// SPDX-License-Identifier: Apache-2.0
#include "services/devices/leap_calibration.hpp"

#include <fmt/format.h>

#include <cstdio>

#ifdef HANDCAST_WITH_LIBUSB
#include "services/camera/leap/list.hpp"
#endif

namespace handcast::devices {

#ifdef HANDCAST_WITH_LIBUSB
namespace {

Result<void> write_new_file(const std::string& file, const std::string& text) {
  std::FILE* stream = std::fopen(file.c_str(), "wx");
  const bool is_written = stream && std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  if (stream && std::fclose(stream) == 0 && is_written) return {};
  return fail(Errc::bad_config, fmt::format("'{}' exists, or cannot be written", file));
}

}  // namespace

Result<void> write_leap_calibration(const LeapCalibration& wanted) {
  int width_px = 0, height_px = 0, end = 0;
  if (std::sscanf(wanted.size.c_str(), "%4dx%4d%n", &width_px, &height_px, &end) != 2 ||
      static_cast<std::size_t>(end) != wanted.size.size() || width_px < 1 || height_px < 1)
    return fail(Errc::bad_config,
                fmt::format("'{}' is no size; for instance 640x480", wanted.size));
  if (wanted.eye != "left" && wanted.eye != "right")
    return fail(Errc::bad_config,
                fmt::format("'{}' is no eye; there are left and right", wanted.eye));
  const auto text = camera::leap::calibration_file_from(wanted.device, wanted.eye == "right",
                                                        width_px, height_px);
  if (!text) return tl::make_unexpected(text.error());
  return write_new_file(wanted.file, *text);
}
#else
Result<void> write_leap_calibration(const LeapCalibration&) {
  return fail(Errc::bad_config, "this build reads no Leap Motion Controllers (libusb-1.0-0-dev)");
}
#endif

}  // namespace handcast::devices
