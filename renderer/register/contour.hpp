// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "renderer/mask/silhouette.hpp"

namespace handcast::renderer {

/// Points on the edge of a silhouette, to a fraction of a pixel, evenly spaced, in no particular
/// order.
struct Contour {
  /// Capacity. If the edge has more points, every 2nd, 4th, ... is kept.
  static constexpr int kMostPoints = 640;

  int count = 0;                                 ///< entries in use of the arrays below
  std::array<glm::vec2, kMostPoints> points_px;  ///< image px
  std::array<glm::vec2, kMostPoints> normals;    ///< unit, away from the hand
};

/// Replaces `contour` by the edge of `silhouette`.
void find_contour(const Silhouette& silhouette, Contour& contour);

/// Distance in px from `from` along `direction` (unit) to the edge of the hand; negative if `from`
/// is outside the hand and the edge lies in the opposite direction. Empty if there is no edge
/// within `reach_px`.
std::optional<float> edge_along(const Silhouette& silhouette, glm::vec2 from, glm::vec2 direction,
                                float reach_px);

}  // namespace handcast::renderer
