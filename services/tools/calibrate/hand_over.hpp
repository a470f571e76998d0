// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/calibrate/session.hpp"

namespace handcast::calibrate {

/// Puts what the session has measured, now or in earlier calls, in its place, and prints where it
/// is: the calibration, and the settings for the rig file, which --apply writes there. If the rig
/// file does not name the calibration yet, its name becomes one of the settings, relative to the
/// rig file where that is short; on the twin, whose truth is the calibration that its rig names,
/// twin.geometry.calibration becomes another, with a copy of `running`, the calibration of before.
/// Errors: those of Session::finish() and apply_settings().
Result<void> hand_over(const Options& options, const config::Rig& rig,
                       const calib::Calibration& running, Session& session);

}  // namespace handcast::calibrate
