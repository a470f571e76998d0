// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/calibrate/pattern_images.hpp"

namespace handcast::calibrate {

/// Measures by projected grey steps how the projector turns levels into light, and adds the
/// findings, a picture and the value of projector.gamma to an outcome. Takes some seconds. If the
/// camera cannot tell, a finding says so. Errors: those of the streams and of the rig.
Result<void> measure_gamma(Desk& desk, PatternImages& patterns, Outcome& outcome);

}  // namespace handcast::calibrate
