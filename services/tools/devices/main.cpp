// SPDX-License-Identifier: Apache-2.0
// handcast devices: what is attached, and what it would be called in a rig file.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/quote.hpp"
#include "services/tools/devices/attached.hpp"

#ifdef HANDCAST_WITH_LIBUSB
#include "calib/calibration.hpp"
#include "services/camera/leap/controller.hpp"
#endif

namespace handcast::devices {
namespace {

/// What of a Leap Motion Controller's own calibration is written.
struct LeapCalibration {
  std::string file;              ///< must not exist
  std::string device;            ///< serial number or USB port; empty: the only one
  std::string eye = "left";      ///< or "right"
  std::string size = "640x480";  ///< of the images
};

#ifdef HANDCAST_WITH_LIBUSB

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

/// Writes a calibration file with the lenses that the controller has measured itself. Errors:
/// bad_config (the file exists or cannot be written, no such size or eye, lenses that no program
/// would accept, not in this build), those of the controller. After an error the file is not there,
/// unless it was before.
Result<void> write_leap_calibration(const LeapCalibration& wanted) {
  constexpr int kLeast_px = 16, kMost_px = 8192;  // as of a calibration file
  const auto is_side = [](int side_px) { return side_px >= kLeast_px && side_px <= kMost_px; };
  int width_px = 0, height_px = 0, end = 0;
  if (std::sscanf(wanted.size.c_str(), "%4dx%4d%n", &width_px, &height_px, &end) != 2 ||
      static_cast<std::size_t>(end) != wanted.size.size() || !is_side(width_px) ||
      !is_side(height_px))
    return fail(Errc::bad_config,
                fmt::format("{} is no size like 640x480, with {} to {} px on a side",
                            quote(wanted.size), kLeast_px, kMost_px));
  if (wanted.eye != "left" && wanted.eye != "right")
    return fail(Errc::bad_config, quote(wanted.eye) + " is no eye; there are left and right");
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

}  // namespace
}  // namespace handcast::devices

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  CommandLine line(
      "handcast devices",
      "Lists the cameras, displays, projector controllers and hand trackers of this computer, with "
      "the settings that use them, and why one cannot be opened.");
  bool as_json = false;
  line.add("--json", as_json, "The same as JSON");
  devices::LeapCalibration leap;
  line.add("--leap-calibration FILE", leap.file,
           "Write a calibration file with the lenses that a Leap Motion Controller has measured "
           "itself; its projector and tracker are still to be calibrated");
  line.add("--leap DEVICE", leap.device, "Its serial number or USB port; default: the only one");
  line.add("--eye NAME", leap.eye, "The first camera: left or right");
  line.add("--size SIZE", leap.size, "Size of its images");
  if (const auto code = line.answered(argc, argv)) return *code;
  if (!leap.file.empty()) {
    const auto written = devices::write_leap_calibration(leap);
    if (written) return kExitDone;
    fmt::print(stderr, "handcast devices: {}\n", printable(written.error().what));
    return exit_code_of(written.error());
  }
  const auto attached = devices::all_attached();
  fmt::print("{}", as_json ? devices::to_json(attached)
                           : printable(devices::print(attached, devices::blind_spots(),
                                                      devices::missing_trackers())));
  return kExitDone;
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast devices", argc, argv, run_verb);
}
