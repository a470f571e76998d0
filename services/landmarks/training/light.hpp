// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "services/landmarks/training/dice.hpp"

namespace handcast::landmarks::training {

/// A surface in camera axes (metres) and what it reflects.
struct Surface {
  std::vector<glm::vec3> positions, normals;
  std::vector<float> albedo;
};

/// An infrared lamp beside the lens, and how skin answers it.
class Light {
 public:
  Light(Dice& dice, const glm::vec3& hand_m);

  /// Grey values, about 1 for a bright skin that faces the lamp at the hand's distance.
  void shade(const Surface& surface, std::vector<float>& grey) const;
  const glm::vec3& lamp_m() const { return lamp_m_; }

 private:
  glm::vec3 lamp_m_;
  float distance_m_;
  float falloff_;  ///< exponent of 1/distance
  float wrap_;  ///< how far light reaches around to what faces away, as if scattered under the skin
  float contrast_;
  float gloss_;
  glm::vec2 spot_m_;  ///< middle of the beam at the hand's distance
  float beam_m_;      ///< its width there; 0: it is even
  float plane_m_;
};

/// Dims what lies in the corners between `balls` (middles of the hand's parts): ambient occlusion
/// by spheres.
void occlude(const Surface& surface, std::span<const glm::vec3> balls, float strength,
             std::vector<float>& grey);

}  // namespace handcast::landmarks::training
