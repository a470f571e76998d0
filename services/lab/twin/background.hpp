// SPDX-License-Identifier: Apache-2.0
/// What is behind the hands and does not move, and the light on all that is seen.
#pragma once
#include <algorithm>
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "config/sections/twin/image.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/twin/random.hpp"

namespace handcast::twin {

// The light of the twin's infrared lamp, which is at the camera's lens.

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

/// Share of the lamp's light that reaches a pixel of the image through the lens.
float vignette_at(const calib::CameraModel& camera, float x_px, float y_px);

/// Direction towards the sun, camera axes, unit.
glm::vec3 to_sun();

/// The grey values of the scene without hands: settings.background, brighter towards the sun, and
/// settings.clutter as bars and discs that `random` places.
renderer::Image<float> make_background(const config::TwinImage& settings,
                                       const calib::CameraModel& camera, const Random& random);

}  // namespace handcast::twin
