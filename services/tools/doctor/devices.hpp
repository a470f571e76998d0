// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "services/tools/devices/attached.hpp"
#include "services/tools/doctor/finding.hpp"
#include "services/tools/doctor/tracker.hpp"

namespace handcast::doctor {

/// Looks for the cameras and the projector's controller of a rig as their services would open them,
/// and opens them if the rig is not up: are they there, can this user open them, does another
/// program use them, and are they those of the calibration? No findings for back ends without a
/// device. Displays: examine_display(); trackers: examine_tracker().
std::vector<Finding> examine_devices(const config::Rig& rig, Asking asking);

/// What is attached in place of a device that is missing, e.g. "attached: 'HD Webcam' (/dev/video0)
/// (camera.backend = "v4l2")"; "no camera is attached".
std::string instead_of_missing(devices::Kind kind, const std::vector<devices::Attached>& attached);

}  // namespace handcast::doctor
