// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "calib/calibration.hpp"
#include "config/settings/load.hpp"

namespace handcast::calib {

/// Adds a fault for each part of a calibration that no rig can have: sizes, lenses, transforms that
/// are not rigid, homographies that miss the camera's image, a parallax by which they do a little
/// nearer or farther, a second camera that sees nothing of what the first one sees. `file` is used
/// in messages.
void check_plausible(const Calibration& calibration, std::string_view file, config::Faults& faults);

}  // namespace handcast::calib
