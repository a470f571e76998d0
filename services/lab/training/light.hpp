// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "services/lab/training/dice.hpp"

namespace handcast::landmarks::training {

/// The vertices of a surface.
struct Surface {
  /// Positions (metres) and normals in camera axes.
  /// @{
  std::vector<glm::vec3> positions, normals;
  /// @}
  std::vector<float> albedo;  ///< the fraction of the light that each vertex reflects
};

/// An infrared lamp beside the lens, and how skin reflects it.
class Light {
 public:
  /// Draws a lamp for a hand at `hand_m` (camera axes, metres).
  Light(Dice& dice, const glm::vec3& hand_m);

  /// Sets the grey value of each vertex, about 1 for bright skin that faces the lamp at the hand's
  /// distance.
  void shade(const Surface& surface, std::vector<float>& grey) const;
  /// The position of the lamp in camera axes.
  const glm::vec3& lamp_m() const { return lamp_m_; }

 private:
  glm::vec3 lamp_m_;
  float distance_m_;
  float falloff_;  ///< exponent of 1/distance
  float wrap_;     ///< how far light reaches surfaces that face away: scattering under the skin
  float contrast_;
  float gloss_;
  glm::vec2 spot_m_;  ///< centre of the beam at the hand's distance
  float beam_m_;      ///< its width there; 0: the light is uniform
  float plane_m_;
};

/// Darkens vertices by ambient occlusion; the occluders are spheres around `balls`, the centres of
/// the hand's parts.
void occlude(const Surface& surface, std::span<const glm::vec3> balls, float strength,
             std::vector<float>& grey);

}  // namespace handcast::landmarks::training
