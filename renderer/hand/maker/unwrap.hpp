// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/hand/maker/glove_fit.hpp"

namespace handcast::renderer {

/// Texture coordinates per file vertex (u right, v down, 0..1) of a left hand, laid out for a
/// picture of kAtlasAspect: the back on the left, the palm on the right, fingers up, each as seen
/// from outside, so that text on either reads right.
std::vector<glm::vec2> unwrapped(const SkinPoints& points, const GloveTemplate& glove,
                                 const std::vector<Triangle>& back,
                                 const std::vector<Triangle>& palm);

}  // namespace handcast::renderer
