// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/lab/twin/random.hpp"
#include "services/lab/twin/solid.hpp"

/// Faults of the twin's camera images.
namespace handcast::twin {

/// Brightness of each vertex of a hand as a factor: 0 under a dark blob, else 1. The blobs cover
/// `share` of the surface in front of the wrist.
std::vector<float> draw_holes(const renderer::HandMesh& hand, double share, const Random& random);

/// Makes a head behind the hands, in the upper right of the image, for hands that are 0.73 m from
/// the camera; it is 0.22 m behind them. Camera axes, metres.
Solid make_face(const calib::CameraModel& camera);
/// Displacement of the head at a time since the epoch: at most 8 mm per axis.
glm::vec3 face_sway_m(std::int64_t time_ns);

/// Applies under- or overexposure and the dark object at the left edge of the image to one row of
/// pixels, before noise is added.
void spoil_row(const config::TwinImage& settings, std::span<std::uint8_t> row);

}  // namespace handcast::twin
