// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/lab/hand_maker/glove_fit.hpp"

namespace handcast::renderer {

/// The skin weights of one vertex.
struct VertexWeights {
  std::array<std::uint8_t, 4> joints{};  ///< XR joints, in descending order of weight
  std::array<float, 4> weights{};        ///< sum to 1; 0 if unused
};

/// The skin weights of the glued vertices. Each vertex belongs to the nearest bone of its part of
/// the hand. The weights are diffused over the skin by two implicit heat steps, further in the palm
/// than on the fingers, and reduced to the four largest.
std::vector<VertexWeights> skin_weights(const SkinPoints& points,
                                        const std::vector<Triangle>& triangles,
                                        const GloveTemplate& glove, const RestPose& rest);

}  // namespace handcast::renderer
