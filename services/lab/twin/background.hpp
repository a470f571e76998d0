// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration.hpp"
#include "config/sections/twin/image.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/twin/random.hpp"

/// What is behind the hands and does not move.
namespace handcast::twin {

/// Share of the lamp's light that reaches a pixel of the image through the lens.
float vignette_at(const calib::CameraModel& camera, float x_px, float y_px);

/// Direction towards the sun, camera axes, unit.
glm::vec3 to_sun();

/// The grey values of the scene without hands: settings.background, brighter towards the sun, and
/// settings.clutter as bars and discs that `random` places.
renderer::Image<float> make_background(const config::TwinImage& settings,
                                       const calib::CameraModel& camera, const Random& random);

}  // namespace handcast::twin
