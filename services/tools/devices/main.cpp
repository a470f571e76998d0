// SPDX-License-Identifier: Apache-2.0
// handcast devices: what is attached, and what it would be called in a rig file.
#include <fmt/format.h>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "services/tools/devices/attached.hpp"
#include "services/tools/devices/leap_calibration.hpp"

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
    fmt::print(stderr, "handcast devices: {}\n", written.error().what);
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
