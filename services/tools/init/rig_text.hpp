// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "services/tools/init/interview.hpp"

namespace handcast::init {

/// How a display shows the light.
struct Showing {
  double rate_hz = 60;
  std::string mode;        ///< to be set, for a display without a window system; empty: need not be
  bool is_scaled = false;  ///< the display has no mode of the calibration's size
  Size size;               ///< of the mode
};
Showing showing_of(const Plan& plan);

/// A file as a command names it: in quotes if a shell would split or change it.
std::string shell_word(const std::string& file);

/// The command that makes the calibration of the plan's devices: "handcast calibrate rig.toml
/// --camera 640x480 --projector 1280x800".
std::string calibrate_command(const Plan& plan, const std::filesystem::path& file);

/// The commented rig file of a plan. `file`: where it will be; a calibration in its folder or below
/// is named relative to it.
std::string rig_text(const Plan& plan, const std::filesystem::path& file);

}  // namespace handcast::init
