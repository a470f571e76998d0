// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Measures the camera's lens by a board that a person holds: takes an image whenever the board is
/// still at a new place, until the whole image and all tilts are covered, Enter is pressed, or the
/// time is over. Sets draft.camera. Errors: those of calib::fit_lens() and of the streams.
Result<Outcome> measure_lens(Desk& desk);

}  // namespace handcast::calibrate
