// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "config/sections/twin/image.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/lab/twin/random.hpp"

namespace handcast::twin {

/// What varies over the skin and moves with it, as a factor of the grey value by vertex of a hand:
/// - texture: noise of 4 mm and 15 mm, and dark creases at the bends of the fingers;
/// - subsurface_mm: light that leaves the skin elsewhere than it entered, more of it in thin parts;
/// - leak: the projected picture as the camera sees it, stripes of 24 mm.
/// Empty if the settings ask for none.
std::vector<float> skin_pattern(const renderer::HandMesh& hand, const config::TwinImage& settings,
                                const Random& random);
/// The noise of skin_pattern() at points of any surface (m), a factor by point.
std::vector<float> noise_pattern(std::span<const glm::vec3> points_m, double contrast,
                                 const Random& random);

/// How far light reaches round the terminator: 0 is Lambert's law, 1 reaches the far side. A
/// subsurface path as long as a finger's radius (8 mm) gives one half.
float wrap_of(double subsurface_mm);

}  // namespace handcast::twin
