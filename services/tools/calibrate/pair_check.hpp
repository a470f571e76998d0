// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/solve/pair/pair_off.hpp"
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Compares the place of the second camera with a board that is held still before both cameras.
/// Changes nothing. Errors: bad_data (the cameras never saw the board together), those of
/// look_at_pair().
Result<Outcome> check_pair(Desk& desk);

/// The verdict of check_pair(), without its images. `square_mm`: of the board, as the person says.
Outcome judge_pair(const calib::PairOff& off, double square_mm);

}  // namespace handcast::calibrate
