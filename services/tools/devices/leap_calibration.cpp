// SPDX-License-Identifier: Apache-2.0
#include "services/tools/devices/leap_calibration.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#ifdef HANDCAST_WITH_LIBUSB
#include "calib/calibration.hpp"
#include "services/camera/leap/controller.hpp"
#endif

namespace handcast::devices {

#ifdef HANDCAST_WITH_LIBUSB
namespace {

/// Writes a file that did not exist, and reads it back as the programs do. On an error there is no
/// file.
Result<void> write_new_file(const std::string& file, const std::string& text) {
  std::FILE* stream = std::fopen(file.c_str(), "wx");
  if (!stream)
    return fail(Errc::bad_config,
                fmt::format("'{}' cannot be made: {}", file, std::strerror(errno)));
  bool is_written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  is_written = std::fclose(stream) == 0 && is_written;
  Result<void> problem;
  if (!is_written)
    problem = fail(Errc::bad_config,
                   fmt::format("'{}' cannot be written: {}", file, std::strerror(errno)));
  else if (const auto read = calib::load_calibration(file); !read)
    problem = fail_in("the controller's lenses make no calibration", read.error());
  if (!problem) std::remove(file.c_str());
  return problem;
}

}  // namespace

Result<void> write_leap_calibration(const LeapCalibration& wanted) {
  constexpr int kLeast_px = 16, kMost_px = 8192;  // as of a calibration file
  const auto is_side = [](int side_px) { return side_px >= kLeast_px && side_px <= kMost_px; };
  int width_px = 0, height_px = 0, end = 0;
  if (std::sscanf(wanted.size.c_str(), "%4dx%4d%n", &width_px, &height_px, &end) != 2 ||
      static_cast<std::size_t>(end) != wanted.size.size() || !is_side(width_px) ||
      !is_side(height_px))
    return fail(Errc::bad_config,
                fmt::format("'{}' is no size like 640x480, with {} to {} px on a side", wanted.size,
                            kLeast_px, kMost_px));
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
