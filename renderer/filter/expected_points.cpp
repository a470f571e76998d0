// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/expected_points.hpp"

#include <algorithm>

namespace handcast::renderer {

glm::vec2 median_of(std::span<glm::vec2> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  glm::vec2 median;
  for (int axis = 0; axis < 2; ++axis) {
    std::nth_element(values.begin(), middle, values.end(),
                     [axis](glm::vec2 a, glm::vec2 b) { return a[axis] < b[axis]; });
    median[axis] = (*middle)[axis];
  }
  return median;
}

float common_error_px(const msg::HandLandmarks& seen, const ExpectedPoints& expected) {
  std::array<glm::vec2, kLandmarks> errors_px;
  std::size_t count = 0;
  for (int i = 0; i < kLandmarks; ++i)
    if (was_seen(seen.points[i]) && expected.known[i])
      errors_px[count++] = position_px(seen.points[i]) - expected.px[i];
  return count > 0 ? glm::length(median_of(std::span(errors_px).first(count))) : 0;
}

}  // namespace handcast::renderer
