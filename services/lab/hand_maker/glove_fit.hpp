// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/lab/hand_maker/glove_layout.hpp"
#include "services/lab/hand_maker/hand_field.hpp"

namespace handcast::renderer {

/// Positions of the glued vertices on a skin, millimetres.
using SkinPoints = std::vector<glm::dvec3>;

/// The initial positions on the skin. Fingers are pushed out from the sheet; the palm is found by
/// rays from outside along the dorsal direction, because rays from inside would not reach the
/// thenar.
SkinPoints place_on_skin(const GloveTemplate& glove, const GloveLayout& layout,
                         const HandField& field);

/// Moves the vertices along the skin, so that they become evenly spread and the seam follows the
/// silhouette as seen from the back.
void relax_on_skin(SkinPoints& points, const GloveTemplate& glove, const GloveLayout& layout,
                   const HandField& field, int rounds);

/// Moves the vertices of `carried` to the skin of `field`, which must be near. Each vertex follows
/// the mean displacement of its neighbours, which preserves the spacing and with it the texture and
/// the weights.
SkinPoints settled_on_skin(const SkinPoints& carried, const GloveTemplate& glove,
                           const HandField& field, int rounds);

}  // namespace handcast::renderer
