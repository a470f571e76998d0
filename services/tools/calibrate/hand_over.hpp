// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/calibrate/session.hpp"

namespace handcast::calibrate {

/// Puts what the session has measured, now or in earlier calls, in its place, and prints where it
/// is: the calibration, and the measured settings, which --apply writes to a file beside the rig
/// file (config::measured_file_of()). If the rig does not name the calibration yet, its name
/// becomes one of the settings, relative to the rig file where that is short; on the twin, whose
/// truth is the calibration that its rig names, twin.geometry.calibration becomes another, with a
/// copy of `running`, the calibration of before. Errors: those of Session::finish(); bad_config (a
/// setting would be refused; nothing is changed), unavailable (a file cannot be written).
Result<void> hand_over(const Options& options, const config::Rig& rig,
                       const calib::Calibration& running, Session& session);

/// Where hand_over() keeps the truth of a twin.
std::filesystem::path truth_of(const Options& options);

/// Takes back what the last call has changed: the calibration file, the measured settings, or both.
/// A second call takes the first one back. Errors: bad_config (nothing is kept), unavailable.
Result<void> undo(const Options& options, const config::Rig& rig);

}  // namespace handcast::calibrate
