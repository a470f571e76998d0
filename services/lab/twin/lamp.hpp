// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <glm/glm.hpp>

/// The light of the twin's infrared lamp, which is at the camera's lens.
namespace handcast::twin {

constexpr float kNominal_m = 0.73f;  ///< distance to which twin.image.gain applies
constexpr float kScattered = 0.4f;   ///< share of the light that is independent of the normal

/// Share of directed light that a surface takes, by the cosine between its normal and the
/// direction to the light. `wrap`: see wrap_of(); 0 is Lambert's law.
inline float facing(float cosine, float wrap) {
  return std::max(0.0f, (cosine + wrap) / (1 + wrap));
}

/// The lamp's light on a point (camera space, m) of a surface with this unit normal, relative to a
/// surface that faces the lamp at the nominal distance. It falls with 1/r^2.
inline float lamp_on(const glm::vec3& point_m, const glm::vec3& normal, float wrap) {
  const float distance = glm::length(point_m);
  const float faces = facing(-glm::dot(normal, point_m) / distance, wrap);
  const float fall = kNominal_m * kNominal_m / (distance * distance);
  return (kScattered + (1 - kScattered) * faces) * fall;
}

}  // namespace handcast::twin
