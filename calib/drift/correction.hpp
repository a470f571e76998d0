// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/drift/drift_watch.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calib {

/// The largest correction; beyond, the tracker must be measured anew.
/// @{
inline constexpr double kMostCorrection_mm = 20, kMostCorrection_deg = 3;
/// @}

/// camera_from_tracker of a calibration, moved as a drift says. The shift along the camera's axis,
/// which landmarks hardly show, is moved by at most 3 mm. Errors: bad_data (the tracker has not
/// moved beyond doubt, or by more than the largest correction).
Result<glm::dmat4> corrected(const Calibration& calibration, const Drift& drift);

}  // namespace handcast::calib
