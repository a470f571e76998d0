// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/content/projegraphy/recogniser.hpp"

namespace handcast::projegraphy {

/// Side of a picture; it covers the mask of its silhouette.
inline constexpr int kPictureSide_px = 2 * kMaskSide_px;

/// Paints the animal in the shape of a silhouette: RGBA8, opaque. Beyond the silhouette its surface
/// goes on, so that the edge of the hand is not dark. The same each time. Any thread.
renderer::Texture painted(const Silhouette& silhouette, const Recognised& recognised);
/// What is shown on hands that look like no animal: soft waves, of the same size.
renderer::Texture calm_picture();

}  // namespace handcast::projegraphy
