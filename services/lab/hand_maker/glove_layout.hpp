// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/lab/hand_maker/glove_template.hpp"

namespace handcast::renderer {

/// The position of the sheet inside a person's hand, by sheet vertex. Millimetres.
struct GloveLayout {
  std::vector<glm::dvec3> middle;      ///< a point between back and palm
  std::vector<glm::dvec3> dorsal;      ///< unit vector to the back of the hand or finger
  std::vector<double> half_thickness;  ///< estimated distance from the middle to the skin
};

/// Lays the sheet into the hand of `shape`, whose rest pose must be `rest`.
GloveLayout lay_out_glove(const GloveTemplate& glove, const HandShape& shape, const RestPose& rest);

}  // namespace handcast::renderer
