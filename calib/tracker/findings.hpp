// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/tracker/evidence.hpp"
#include "calib/tracker/fit_tracker.hpp"

namespace handcast::calib {

/// Sets the quality and the findings of a fit from its figures and the evidence.
void judge(const Evidence& evidence, TrackerFit& fit);

}  // namespace handcast::calib
