// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/solve/tracker/evidence.hpp"
#include "calib/solve/tracker/fit_tracker.hpp"

namespace handcast::calib {

/// Sets the quality and the findings of a fit from its figures and the evidence.
void judge(const Evidence& evidence, TrackerFit& fit);

}  // namespace handcast::calib
