// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Measures where the second camera is from a board that both see; sets
/// draft.camera2->from_camera. The lenses are those of the draft. Errors: bad_config (the rig has
/// one camera), those of take_pair_views() and calib::fit_pair().
Result<Outcome> measure_pair(Desk& desk);

}  // namespace handcast::calibrate
