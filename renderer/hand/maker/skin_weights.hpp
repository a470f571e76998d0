// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/hand/maker/glove_fit.hpp"

namespace handcast::renderer {

struct VertexWeights {
  std::array<std::uint8_t, 4> joints{};
  std::array<float, 4> weights{};
};

/// How much each joint moves each glued vertex: the nearest bone that the vertex's part of the hand
/// allows, spread over the skin like heat (two implicit steps; wider in the palm than on the
/// fingers), the four largest.
std::vector<VertexWeights> skin_weights(const SkinPoints& points,
                                        const std::vector<Triangle>& triangles,
                                        const GloveTemplate& glove, const RestPose& rest);

}  // namespace handcast::renderer
