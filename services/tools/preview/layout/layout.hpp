// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "renderer/base/image.hpp"
#include "services/tools/preview/layout/gauges.hpp"
#include "services/tools/preview/layout/layer.hpp"
#include "services/tools/preview/scene/scene.hpp"

namespace handcast::preview {

/// How the preview is shown.
struct Look {
  /// Size in pixels.
  /// @{
  int width_px = 1600, height_px = 900;
  /// @}
  Layers layers = default_layers();  ///< the layers of the camera panel
  bool frozen = false;               ///< says that the picture stands still
  bool help = false;                 ///< shows the keys
  std::string note;                  ///< a sentence at the top; empty: none
};

/// The smallest and the largest side of a picture.
/// @{
inline constexpr int kSmallestSide_px = 320, kLargestSide_px = 8192;
/// @}

/// Draws the whole preview as RGBA8. Sizes are limited to the range above.
renderer::Texture draw(const Scene& scene, const Gauges& gauges, const Look& look);

}  // namespace handcast::preview
