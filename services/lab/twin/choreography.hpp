// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "services/lab/twin/articulation.hpp"

namespace handcast::twin {

/// The pose of a hand at one time, relative to a hand that is held up with its fingers up in the
/// image and its back to the camera. Camera axes (x right, y down, z away), metres and radians.
struct Posture {
  glm::dvec3 shift{0};
  double sway = 0;  ///< rotation of the forearm about the elbow, clockwise in the image
  double turn = 0;  ///< rotation about the forearm
  double nod = 0;   ///< rotation of the wrist, fingers away from the camera
  /// Share of the way to the other hand's place. The left hand passes nearer to the camera.
  double over = 0;
  bool gone = false;  ///< there is no hand
  Bend bend;
};

struct Choreography {
  std::string_view name;
  Posture (*at)(double seconds);
  bool both_hands = false;
  double right_ahead_s = 0;  ///< lead of the right hand over the left
};

/// All built-in motions.
std::span<const Choreography> choreographies();

}  // namespace handcast::twin
