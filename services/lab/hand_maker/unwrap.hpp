// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/lab/hand_maker/glove_fit.hpp"

namespace handcast::renderer {

/// The texture coordinates of a left hand by file vertex: u right, v down, 0..1, for a picture of
/// kAtlasAspect. The back is on the left, the palm on the right, fingers up, both as seen from
/// outside, so that text is not mirrored on either.
std::vector<glm::vec2> unwrapped(const SkinPoints& points, const GloveTemplate& glove,
                                 const std::vector<Triangle>& back,
                                 const std::vector<Triangle>& palm);

}  // namespace handcast::renderer
