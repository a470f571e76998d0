// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>

#include "config/sections/cascade.hpp"
#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "renderer/correct/deform.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// One hand as the painter gets it: topology from the mesh, everything else per vertex in projector
/// space.
struct DrawnHand {
  const HandMesh* mesh = nullptr;
  const Texture* texture = nullptr;
  std::span<const glm::vec2> position_px;  ///< projector px
  std::span<const float> depth_m;          ///< distance along the camera's axis; nearer wins
  std::span<const float> light;            ///< 0..1 factor per vertex; empty: unshaded
};

/// Which surface a pixel shows. 0: none. Otherwise hand index * 64 + chart, so that a step between
/// charts or hands is seen.
using SurfaceId = std::uint8_t;
constexpr SurfaceId surface_id(int hand_index, std::uint8_t chart) {
  return static_cast<SurfaceId>(hand_index * 64 + chart);
}

struct FillCounts {
  int lit = 0;     ///< region D: render and hand
  int filled = 0;  ///< region C that got light
  int dark = 0;    ///< region C that stayed dark: nothing within reach
};

/// A back end: the same passes over the same buffers, compared by tests. Buffers have the
/// projector's size; each pass touches the given region only and leaves the rest undefined. One
/// thread.
class Painter {
 public:
  virtual ~Painter() = default;

  /// Clears `region` and draws the hands into it with a depth test: texture coordinates, surface
  /// ids and colour. The far side of a closed surface may be left out; at equal depth the later
  /// triangle wins.
  virtual void draw(std::span<const DrawnHand> hands, Rect region) = 0;

  /// Moves what was drawn by a warp grid (the paper's correction): the drawing in `from` appears
  /// warped in `region`.
  virtual void warp(const WarpGrid& grid, Rect from, Rect region) = 0;

  /// Removes light where `mask` is 0 and fills hand without light (METHOD section 1, "fill").
  /// `mask` has the projector's size.
  virtual FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings,
                          Rect region) = 0;

  /// The image as it stands: RGBA8, alpha 0 where dark. Valid until the next pass.
  virtual View<const std::uint32_t> colour() = 0;
  /// Texture coordinates and surface ids as they stand (undefined where the id is 0).
  virtual View<const glm::vec2> uv() = 0;
  virtual View<const SurfaceId> surface() = 0;
};

}  // namespace handcast::renderer
