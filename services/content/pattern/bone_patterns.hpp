// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "renderer/base/image.hpp"
#include "renderer/content/chart_map.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::content {

using renderer::ChartMap;
using renderer::HandMesh;
using renderer::Texture;

/// Opaque pictures of the size of `out`. Colours continue outside the charts.
/// @{
/// The charts, each in its colour, and their outlines.
void paint_seams(const HandMesh& hand, Texture& out);
/// A dot and a number where each joint lies under the skin, in the colour of its finger.
void paint_joints(const HandMesh& hand, Texture& out);
/// Each part of the skin in the colour of the joint that moves it most.
void paint_bones(const HandMesh& hand, Texture& out);
/// The skin weight of one joint: dark blue 0, red 1.
void paint_weights(const HandMesh& hand, int joint, Texture& out);
/// The same for a value 0..1 of each joint, on the skin that it moves most.
void paint_bars(const HandMesh& hand, const std::array<double, renderer::kJoints>& values,
                Texture& out);
/// @}

}  // namespace handcast::content
