// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::preview {

/// The meshes of both hands, by side.
using Meshes = std::array<renderer::HandMesh, msg::kMaxHands>;

/// True if size and region of the projector's image make sense; they come from a ring.
bool is_sound(const msg::Projection& projection);

/// The pixels of the projector that the drawn hands cover before the fill: 255, all others 0.
/// Computed from the landings in the message. Hands whose vertices are not those of their mesh, and
/// triangles that are absurdly large or not finite, are left out. `projection`: see is_sound().
renderer::Image<std::uint8_t> coverage(const msg::Projection& projection, const Meshes& meshes);

/// The edges of the drawn hand `hand` of the projection whose triangles face the camera, in
/// pixels of the camera's image at the time of the light. Leaves out what coverage() does.
std::vector<std::pair<glm::vec2, glm::vec2>> visible_edges(const msg::ProjectedHand& hand,
                                                           const Meshes& meshes,
                                                           const calib::Calibration& calibration);

/// The whole image of the projector, black and transparent outside of the lit region.
renderer::Texture whole_light(const msg::Projection& projection);

}  // namespace handcast::preview
