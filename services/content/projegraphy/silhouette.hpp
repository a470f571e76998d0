// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::projegraphy {

inline constexpr int kMaskSide_px = 256;

/// A hand in the plane of the projector.
struct FlatHand {
  const renderer::HandMesh* mesh = nullptr;
  std::vector<glm::vec2> px;  ///< by vertex
};

/// What one or two hands cover of the projector's plane, as large as the square mask permits.
struct Silhouette {
  /// 1 on the hands, 0 elsewhere; kMaskSide_px square. `skin` has the forearm, too.
  /// @{
  renderer::Image<std::uint8_t> mask{kMaskSide_px, kMaskSide_px}, skin = mask;
  /// @}
  /// Mask px = (projector px - origin_px) * scale.
  /// @{
  glm::vec2 origin_px{0};
  float scale = 1;
  /// @}
  int area_px = 0;  ///< pixels of the mask that are 1; 0: nothing is seen

  glm::vec2 from_projector(const glm::vec2& px) const { return (px - origin_px) * scale; }
};

/// Draws it. Vertices that are not finite or far outside are left out.
Silhouette silhouette_of(std::span<const FlatHand> hands);

/// The share of the joint area that both masks cover: 1 for equal ones.
float overlap_of(const Silhouette& a, const Silhouette& b);

}  // namespace handcast::projegraphy
