// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>

#include "renderer/filter/landmark_filter.hpp"

namespace handcast::renderer {

/// Where landmarks are expected.
struct ExpectedPoints {
  std::array<glm::vec2, kLandmarks> px{};  ///< undistorted camera px
  std::array<bool, kLandmarks> known{};    ///< false: `px` of this landmark is not valid
};
/// The medians in x and in y (of an even number, the larger of the two in the middle). `values`
/// must not be empty; their order changes.
glm::vec2 median_of(std::span<glm::vec2> values);

/// The displacement of the seen landmarks from the expected ones that all have in common: the
/// length of the vector of the medians in x and in y. 0 if no landmark is both seen and expected.
float common_error_px(const msg::HandLandmarks& seen, const ExpectedPoints& expected);

}  // namespace handcast::renderer
