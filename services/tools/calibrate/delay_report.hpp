// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/solve/latency/light_delay.hpp"
#include "config/rig.hpp"
#include "services/tools/calibrate/session.hpp"

namespace handcast::calibrate {

/// Adds to an outcome what a delay of the light means for the rig, and the value of
/// projector.latency_ms if the rig's own is wrong by more than the delay's interval.
void report_delay(const config::Rig& rig, const calib::LightDelay& delay, Outcome& outcome);

}  // namespace handcast::calibrate
