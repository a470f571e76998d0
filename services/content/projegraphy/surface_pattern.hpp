// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

#include "services/content/projegraphy/drawing.hpp"

namespace handcast::projegraphy {

/// How light a pattern is at a place, about 0..1. `at`: in units of the root of the animal's area;
/// `along`: unit length, the way in which hair and feathers lie.
float lightness_of(Pattern pattern, const glm::vec2& at, const glm::vec2& along);

}  // namespace handcast::projegraphy
