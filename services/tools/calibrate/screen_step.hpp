// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Measures where the projector's pixels fall: by structured light on a board that stands still at
/// several distances; by hand if the camera does not see the light. Sets the projector of the
/// draft. Needs the lens. Errors: those of calib::fit_screen() and of the streams.
Result<Outcome> measure_screen(Desk& desk);

}  // namespace handcast::calibrate
