// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/hand/maker/glove_layout.hpp"
#include "renderer/hand/maker/hand_field.hpp"

namespace handcast::renderer {

/// Glued vertices on a skin (millimetres).
using SkinPoints = std::vector<glm::dvec3>;

/// First places on the skin: fingers pushed out from the sheet, the palm met by rays from outside
/// along the dorsal direction (from inside one would stop short of the thenar).
SkinPoints place_on_skin(const GloveTemplate& glove, const GloveLayout& layout,
                         const HandField& field);

/// Slides the vertices over the skin until they are evenly spread and the seam runs along the
/// silhouette as seen from the back.
void relax_on_skin(SkinPoints& points, const GloveTemplate& glove, const GloveLayout& layout,
                   const HandField& field, int rounds);

/// Puts a skin that is nearly right on the skin of `field`: every vertex goes where its neighbours
/// go, so that the spacing of `carried`, to which texture and weights belong, is kept.
SkinPoints settled_on_skin(const SkinPoints& carried, const GloveTemplate& glove,
                           const HandField& field, int rounds);

}  // namespace handcast::renderer
