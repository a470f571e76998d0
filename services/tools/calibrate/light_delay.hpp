// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/solve/latency/light_delay.hpp"
#include "services/tools/calibrate/desk.hpp"

/// How much later than reported the light comes. PatternImages measures it by the camera.
namespace handcast::calibrate {

/// Measures it by a light that toggles and a photodiode on a sound card (options.photodiode); the
/// camera is not needed. Takes about 6 s. The low end of the interval is 2 ms lower than the
/// samples say, because a sound card delivers them up to so much late. Errors: those of
/// open_sound_card(), Recorder, calib::fit_sound_delay() and of the streams.
Result<calib::LightDelay> measure_delay_by_sound(Desk& desk);

/// Adds to an outcome what a delay of the light means for the rig, and the value of
/// projector.latency_ms if the rig's own is wrong by more than the delay's interval.
void report_delay(const config::Rig& rig, const calib::LightDelay& delay, Outcome& outcome);

}  // namespace handcast::calibrate
