// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Measures where the tracker is by an ordinary hand that moves through the working volume: its
/// joints by the tracker, its landmarks in the camera's images. Sets draft.camera_from_tracker.
/// Errors: bad_data (there was no hand, or the two do not fit), and those of the streams.
Result<Outcome> measure_tracker(Desk& desk);

/// Compares the calibration in use with what measure_tracker() finds, and changes nothing; is_good:
/// the tracker is right within 2.5 mm across and 6 mm along the camera's axis, or within what the
/// fit does not know.
Result<Outcome> check_tracker(Desk& desk);

}  // namespace handcast::calibrate
