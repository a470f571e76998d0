// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "ipc/msg/made_from.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/draw/painter.hpp"
#include "renderer/ladder/rung.hpp"

namespace handcast::renderer {

/// One hand of a finished frame, for scores and traces.
struct FrameHand {
  Side side = Side::left;
  LandmarkPoints tracker{};    ///< P at the target time, undistorted camera px
  LandmarkPoints corrected{};  ///< Q̂ (P if nothing corrects)
  bool has_landmarks =
      false;  ///< corrected follows what the filter knows, even if P is best left alone
  std::span<const glm::vec2> landings;  ///< per vertex: where its light lands, projector px
  Rung rung = Rung::landmarks;
};

/// One finished frame. Everything it points to is valid until the next render().
struct Frame {
  std::int64_t target_ns = 0;
  msg::MadeFrom made_from;
  Rect region;  ///< all light is inside
  View<const std::uint32_t>
      colour;  ///< the projector's size; defined inside `region`; alpha 0: dark
  std::span<const FrameHand> hands;
  int foldovers = 0;
  FillCounts fill;
  std::span<const msg::StageMark> stages;  ///< of this frame, on the host's clock
};

}  // namespace handcast::renderer
