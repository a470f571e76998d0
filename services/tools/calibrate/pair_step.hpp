// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/solve/pair/pair_fit.hpp"
#include "calib/solve/pair/pair_off.hpp"
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Which views of a board: of many places, near and far, or some of any one place.
enum class PairWanted { places, one_place };

/// What both cameras saw of a board.
struct PairSeen {
  std::vector<calib::PairView> views;
  /// Images of the first camera with a still board that the second camera did not see, although it
  /// should by the calibration.
  int missing = 0;
};

/// Takes views of a board that both cameras see while it is still, until there are enough, Enter is
/// pressed or the time is over. The two images of a view are those whose exposures are nearest to
/// each other. Errors: those of client::Stream and of the rig.
Result<PairSeen> take_pair_views(Desk& desk, PairWanted wanted);

/// What --check says of a second camera that is off by this. `square_mm`: of the board, as the
/// person says.
Outcome judge_pair(const calib::PairOff& off, double square_mm);

}  // namespace handcast::calibrate
