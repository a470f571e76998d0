// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "config/sections/cascade.hpp"
#include "tests/renderer/poses.hpp"

namespace handcast::bench {

/// What the frames show: hands swaying 0.6 m/s before the reference rig.
struct FrameScene {
  std::string name;
  int hands = 1;  ///< the left one, or both
  renderer::samples::Pose pose = renderer::samples::kOpen;
  double distance_m = 0.73;  ///< as far as the twin's
  /// Size of the screen and of the camera's image. The hand keeps its size in pixels.
  /// @{
  int screen_width_px = 1024, screen_height_px = 768, image_width_px = 720, image_height_px = 540;
  /// @}
  bool smooth = true;  ///< config::Content::smooth
  int threads = 1;     ///< config::Projector::painter_threads
  config::Cascade cascade{};
};

struct FrameTimes {
  std::vector<double> frame_us;                         ///< render() as its caller sees it
  std::map<std::string, std::vector<double>> stage_us;  ///< by msg::kStageNames
  int lit_px = 0, filled_px = 0, region_px = 0;         ///< of the last frame
  std::string error;                                    ///< where it could not run
};

/// Whole frames of Pipeline on one core, the scenes in short turns, so that whatever else the
/// machine does meets all alike. The tracker is 9 ms and the landmarks are 16 ms late and 5 px
/// off.
std::vector<FrameTimes> time_frames(std::span<const FrameScene> scenes, int frames);

}  // namespace handcast::bench
