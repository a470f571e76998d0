// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "config/sections/cascade.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "renderer/base/device_image.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/mip_chain.hpp"
#include "renderer/correct/deform.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// One hand to be drawn: topology from the mesh, everything else per vertex. Borrowed for the call
/// of draw(), the picture until the last fill() of the drawing.
struct DrawnHand {
  const HandMesh* mesh = nullptr;          ///< triangles, texture coordinates and charts
  MipView picture;                         ///< without texels: white
  std::span<const glm::vec2> position_px;  ///< projector px
  std::span<const float> depth_m;          ///< along the projector's axis; nearer wins
  std::span<const float> light;            ///< factor of the levels, 0..1; empty: 1 everywhere
  /// Numbers of the contents of `mesh` and `picture`, see new_revision(): as long as one is the
  /// same, a back end may draw with a copy that it made before. 0: the contents may have changed.
  /// @{
  std::uint64_t mesh_revision = 0;
  std::uint64_t picture_revision = 0;
  /// @}
};

/// A number that no DrawnHand had before. Any thread.
inline std::uint64_t new_revision() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;  // only distinct, in no order
}

/// The surface that a pixel shows. 0: none. Otherwise hand index * 64 + chart, so that a step
/// between charts or hands can be detected.
using SurfaceId = std::uint8_t;
/// The id of a chart (1..60, see number_charts()) of the hand with the given index (0..3).
constexpr SurfaceId surface_id(int hand_index, std::uint8_t chart) {
  return static_cast<SurfaceId>(hand_index * 64 + chart);
}

/// Numbers of pixels after a fill, by region (paper, "Perceptual Boundary Reduction").
struct FillCounts {
  int lit = 0;     ///< region D: drawing and hand
  int filled = 0;  ///< region C, hand without drawing: filled
  int dark = 0;    ///< region C: not filled, no light within reach
};

/// A back end that draws. All back ends do the same passes on the same buffers and are compared by
/// tests. Buffers have the projector's size. Each pass changes only the given region, clipped to
/// the screen; the rest is undefined. One thread.
class Painter {
 public:
  virtual ~Painter() = default;

  /// Clears `region` and draws the hands into it with a depth test: texture coordinates, surface
  /// ids and colour. The far side of a closed surface may be left out. At equal depth the later
  /// triangle wins.
  virtual void draw(std::span<const DrawnHand> hands, Rect region) = 0;

  /// Moves the drawing by a warp grid (the paper's correction): the drawing in `from` appears
  /// warped in `region`.
  virtual void warp(const WarpGrid& grid, Rect from, Rect region) = 0;

  /// Removes light where `mask` is 0 and fills the parts of the hand that have no light. Where the
  /// mask is between 0 and 255, the share of the pixel that is hand, the pixel gets this share of
  /// its light, and its alpha is the share. The alpha of a fill that fades is its share of the
  /// light. `mask` has the projector's size. Does nothing if the
  /// method is none. See `docs/method.md#fill`.
  virtual FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings,
                          Rect region) = 0;

  /// Removes all light inside `areas`.
  virtual void darken(std::span<const Rect> areas, Rect region) = 0;

  /// The image after the last pass: RGBA8, alpha 0 where it is dark, 255 inside the hand. Valid
  /// until the next pass.
  virtual View<const std::uint32_t> colour() = 0;
  /// The image after the last pass where a GPU keeps it, complete, for an output of the share group
  /// that the painter was opened with; it need not be read back by colour() then. Empty if there is
  /// none. Valid until the next pass.
  virtual std::optional<DeviceImage> device_image() { return {}; }
  /// What the pixels show after the last pass. Texture coordinates are undefined where the id is 0.
  struct Shown {
    View<const glm::vec2> uv;       ///< texture coordinates
    View<const SurfaceId> surface;  ///< surface ids
  };
  /// Defined for the pixels whose coordinates are multiples of `step`; the fewer, the faster. Valid
  /// until the next pass.
  virtual Shown shown(int step) = 0;
  /// The same for all pixels.
  /// @{
  View<const glm::vec2> uv() { return shown(1).uv; }
  View<const SurfaceId> surface() { return shown(1).surface; }
  /// @}

  /// A pass on another processor, and how long it took by the clock of that processor.
  struct DevicePass {
    msg::Stage stage;
    std::int64_t took_ns;
  };
  /// The passes since the last call, if the painter measures them. Ask after colour().
  virtual std::vector<DevicePass> device_passes() { return {}; }

  /// Why the painter has stopped for good, e.g. because its GPU was lost; empty if it has not. Ask
  /// after colour(). Then the image is undefined: draw the frame again with another painter.
  virtual std::optional<Error> failure() const { return {}; }
};

}  // namespace handcast::renderer
