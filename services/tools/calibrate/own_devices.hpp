// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "services/tools/devices/attached.hpp"

namespace handcast::calibrate {

/// The devices that a calibration was made with, by names that calib::check_device() accepts for
/// them. Empty: it has no name (the twin), or the rig file does not say which of several it is.
struct OwnDevices {
  std::string camera, projector;
  /// All names of each; empty if it is not attached.
  /// @{
  std::vector<std::string> camera_names{}, projector_names{};
  /// @}
  /// The same of a second camera.
  /// @{
  std::string camera2{};
  std::vector<std::string> camera2_names{};
  /// @}
};

/// The devices of a rig. `attached`: those of this computer, in which an unnamed one is looked up.
OwnDevices own_devices(const config::Rig& rig, const std::vector<devices::Attached>& attached);
/// The same with what is attached now. Takes a second if the rig has devices.
OwnDevices own_devices(const config::Rig& rig);

}  // namespace handcast::calibrate
