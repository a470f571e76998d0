// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/ladder/rung.hpp"
#include "renderer/predict/projected_pose.hpp"

namespace handcast::renderer {

/// One hand at the time of the photons, on its rung: it is drawn in its pose and then moved from P
/// onto Q̂.
struct Corrected {
  ProjectedPose posed;         ///< with P
  LandmarkPoints landmarks{};  ///< Q̂, or P if nothing corrects it
  bool has_landmarks = false;  ///< `landmarks` are Q̂, even if the rung leaves them at P
  bool is_alone = false;       ///< see Filtered::is_alone
  bool has_news = true;        ///< see Filtered::has_news

  Rung rung = Rung::landmarks;  ///< the rung of this frame, chosen or set
  /// The model by which the drawing is moved. Below `landmarks` only if that rung has the whole
  /// share of the light.
  Rung moves = Rung::landmarks;
  float registered = 1;  ///< share of late registration in the light, 0..1

  /// Q̂ - P.
  LandmarkPoints offset_px() const { return difference(landmarks, posed.landmarks); }
};

}  // namespace handcast::renderer
