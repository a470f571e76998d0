// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

namespace handcast::bench {

/// The frames of the projector of a rig for some seconds.
struct Frames {
  std::vector<double> frame_us;  ///< Stage::frame
  int missed = 0;                ///< refreshes between two frames without one
};

/// Watches the rig "twin", whose projector has this rate, from now on.
Frames watch_frames(double seconds, double refresh_hz);

}  // namespace handcast::bench
