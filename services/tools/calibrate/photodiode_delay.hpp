// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/solve/latency/light_delay.hpp"
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Measures by a light that toggles and a photodiode on a sound card how much later than reported
/// the light comes; the camera is not needed. Takes about 6 s. The low end of the interval is 2 ms
/// lower than the samples say, because a sound card delivers them up to so much late. Errors: those
/// of open_sound_card(), Recorder, calib::fit_sound_delay() and of the streams.
Result<calib::LightDelay> measure_delay_by_sound(Desk& desk, const std::string& device);

}  // namespace handcast::calibrate
