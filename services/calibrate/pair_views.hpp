// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/pair/pair_fit.hpp"
#include "services/calibrate/desk.hpp"

namespace handcast::calibrate {

/// Takes views of a board that both cameras see while it is still, each at a new place, until there
/// are enough at near and far, Enter is pressed or the time is over. The two images of a view are
/// those whose exposures are nearest to each other. Errors: those of client::Stream and of the rig.
Result<std::vector<calib::PairView>> take_pair_views(Desk& desk);

}  // namespace handcast::calibrate
