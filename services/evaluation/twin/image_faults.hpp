// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/evaluation/twin/random.hpp"

/// What can be wrong with the twin's camera images.
namespace handcast::twin {

/// Brightness of each vertex of a hand, beside skin: 0 under a dark blob. The blobs hold `share` of
/// the surface.
std::vector<float> draw_holes(const renderer::HandMesh& hand, double share, const Random& random);

/// A head behind the hands, upper right of the middle. Camera axes, metres.
struct Face {
  std::vector<glm::vec3> positions, normals;
  std::vector<std::array<std::uint16_t, 3>> triangles;  ///< counter-clockwise from outside
};
Face make_face(const calib::CameraModel& camera);
/// Nobody holds a head quite still.
glm::vec3 face_sway_m(std::int64_t time_ns);

/// Too little or too much light, and something dark before the left of the image, on one row of
/// pixels before their noise.
void spoil_row(const config::TwinImage& settings, std::span<std::uint8_t> row);

}  // namespace handcast::twin
