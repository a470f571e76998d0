// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Looks at a still hand in the projector's light and without it, and advises on exposure,
/// threshold, flicker and the projector's light in the camera. With options.photodiode it also
/// measures when the light comes. Changes nothing in the draft. Errors: bad_data (no hand was
/// seen), those of the streams, of the rig and of the photodiode.
Result<Outcome> measure_light(Desk& desk);

}  // namespace handcast::calibrate
