// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Compares the projector of the calibration in use with where a board that is held still shows its
/// light now; is_good: it is right within 0.7 px. If the camera does not see the light, a finding
/// says so. Changes nothing. Errors: bad_data (no board was held still, or it was not read), those
/// of the streams and of the rig.
Result<Outcome> check_screen(Desk& desk);

}  // namespace handcast::calibrate
