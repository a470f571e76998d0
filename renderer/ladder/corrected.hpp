// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/ladder/rung.hpp"

namespace handcast::renderer {

/// One hand at the time of the photons, as its rung has it: drawn in `pose`, then moved from P onto
/// Q̂.
struct Corrected {
  msg::HandPose pose;          ///< tracker space
  LandmarkPoints tracker{};    ///< P: the pose's landmarks in the camera
  LandmarkPoints landmarks{};  ///< Q̂, or P if nothing corrects it
  bool has_landmarks = false;  ///< landmarks are Q̂, even if it is best left at P
  bool is_alone = false;       ///< Filtered::is_alone
  bool has_news = true;        ///< Filtered::has_news

  Rung rung = Rung::landmarks;   ///< the gate's choice
  Rung moves = Rung::landmarks;  ///< how the drawing is moved: below `landmarks` only if all of the
                                 ///< light is on that rung
  float registered = 1;          ///< how much of late registration is in the light, 0..1

  LandmarkPoints offset_px() const { return difference(landmarks, tracker); }
};

}  // namespace handcast::renderer
