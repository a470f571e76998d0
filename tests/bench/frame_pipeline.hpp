// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

#include "config/sections/cascade.hpp"

namespace handcast::bench {

struct FrameTimes {
  std::vector<double> frame_us;                         ///< render() as its caller sees it
  std::map<std::string, std::vector<double>> stage_us;  ///< by msg::kStageNames
  int lit_px = 0, filled_px = 0;                        ///< of the last frame
  std::string error;                                    ///< where it could not run
};

/// Whole frames of Pipeline on one core: the paper's rig, one left hand `distance_m` away (0.9:
/// some 45,000 px) swaying 0.6 m/s, the tracker 9 ms and the landmarks 16 ms late and 5 px off.
FrameTimes time_frames(const config::Cascade& cascade, double distance_m, int frames);

}  // namespace handcast::bench
