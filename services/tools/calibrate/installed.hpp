// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/calibrate/rig_settings.hpp"

namespace handcast::calibrate {

/// True if the rig of this name is up.
bool is_up(const config::Rig& rig);

/// Error bad_config: the rig is up, and a step needs it down.
Result<void> check_down(const config::Rig& rig);

/// --check: compares an installed rig with its calibration, and changes nothing. Beside a rig that
/// is up, else with one that it starts. Returns kExitBadResult if something has moved. Errors:
/// bad_config (--set with a rig that is up, or it runs with another calibration), those of the
/// checks and of the rig.
Result<int> check_installed(const Options& options, const config::Rig& rig,
                            const RunningAs& running);

}  // namespace handcast::calibrate
