// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "ipc/msg/header.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/correct/rung.hpp"
#include "renderer/draw/painter.hpp"

namespace handcast::renderer {

/// One hand of a finished frame, for scores and traces.
struct FrameHand {
  Side side = Side::left;      ///< which hand it is
  LandmarkPoints tracker{};    ///< P at the target time
  LandmarkPoints corrected{};  ///< Q̂ at the target time, or P if nothing corrects it
  float presence = 1;          ///< factor of all its levels, 0..1
  /// Index among the drawn hands, see surface_id(); -1: not drawn.
  int drawn_as = -1;
  bool has_landmarks = false;               ///< `corrected` is Q̂, even if the rung leaves it at P
  std::span<const glm::vec2> projected_px;  ///< projected vertices: where their light lands
  Rung rung = Rung::landmarks;              ///< the rung of this frame
};

/// One finished frame. Everything it refers to is valid until the next Pipeline::render() or
/// Pipeline::track().
struct Frame {
  std::int64_t target_ns = 0;  ///< the time of its photons (T), CLOCK_MONOTONIC
  msg::MadeFrom made_from;     ///< the newest inputs of this frame
  Rect region;                 ///< contains all light
  /// RGBA8 in the projector's size, alpha 0 where it is dark. Defined inside `region` only. Empty
  /// while the image is only on a GPU.
  View<const std::uint32_t> colour;
  /// What the pixels show (Painter::shown()) whose coordinates are multiples of
  /// msg::Projection::kShownStep_px, in the projector's size and defined inside `region` only.
  /// Empty unless Pipeline::show_surface() is on.
  /// @{
  View<const glm::vec2> uv;
  View<const SurfaceId> surface;
  /// @}
  std::span<const FrameHand> hands;  ///< the hands of this frame
  /// Number of the test picture that it shows in place of hands (msg::TestPicture); 0: none.
  std::uint64_t test_picture = 0;
  int foldovers = 0;                       ///< triangles that the correction turned over
  FillCounts fill;                         ///< pixels of the fill; 0 without an image
  std::span<const msg::StageMark> stages;  ///< of this frame, CLOCK_MONOTONIC
  std::optional<DeviceImage> device;       ///< the image on a GPU, see Painter
};

}  // namespace handcast::renderer
