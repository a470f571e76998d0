// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/hand/maker/glove_template.hpp"

namespace handcast::renderer {

/// Where the sheet lies inside a person's hand: per sheet vertex (millimetres).
struct GloveLayout {
  std::vector<glm::dvec3> middle;      ///< a point between back and palm
  std::vector<glm::dvec3> dorsal;      ///< unit, towards the back of the hand or finger
  std::vector<double> half_thickness;  ///< a first guess of the way to the skin
};

GloveLayout lay_out_glove(const GloveTemplate& glove, const HandShape& shape, const RestPose& rest);

}  // namespace handcast::renderer
