// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "renderer/mask/silhouette.hpp"

namespace handcast::renderer {

/// Points of a silhouette's edge to a fraction of a pixel, evenly along it, in no order. Of an edge
/// with more, every 2nd, 4th, ... Image px.
struct Contour {
  static constexpr int kMostPoints = 640;

  int count = 0;
  std::array<glm::vec2, kMostPoints> points_px;
  std::array<glm::vec2, kMostPoints> normals;  ///< unit, away from the hand
};

void find_contour(const Silhouette& silhouette, Contour& contour);

/// How far along `direction` (unit) from a point the hand ends; negative: the point is outside.
/// Nothing within `reach_px`: no edge.
std::optional<float> edge_along(const Silhouette& silhouette, glm::vec2 from, glm::vec2 direction,
                                float reach_px);

}  // namespace handcast::renderer
