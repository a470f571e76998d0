// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/solve/pair/pair_fit.hpp"
#include "services/tools/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Takes views of a board that both cameras see while it is still, each at a new place, until there
/// are enough at near and far, Enter is pressed or the time is over. The two images of a view are
/// those whose exposures are nearest to each other. Errors: those of client::Stream and of the rig.
Result<std::vector<calib::PairView>> take_pair_views(Desk& desk);

/// What both cameras saw of a board at one place.
struct PairSeen {
  std::vector<calib::PairView> views;
  /// Images of the first camera with a still board that the second camera did not see, although it
  /// should by the calibration.
  int missing = 0;
};

/// Takes some views of a still board, wherever it is. Ends as take_pair_views() does, with the same
/// errors.
Result<PairSeen> look_at_pair(Desk& desk);

}  // namespace handcast::calibrate
