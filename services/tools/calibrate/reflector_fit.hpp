// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/solve/tracker/fit_tracker.hpp"
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Where the tracker is by a retro-reflector on an index finger tip (options.reflector_mm across)
/// that moves through the working volume: its place in the camera's images, and the tips by the
/// tracker. Errors: bad_data (it was not seen, with the reason; or the two do not fit), and those
/// of the streams.
Result<calib::TrackerFit> fit_by_reflector(Desk& desk);

}  // namespace handcast::calibrate
