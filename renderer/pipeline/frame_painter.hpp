// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "config/sections/cascade.hpp"
#include "renderer/draw/painter.hpp"
#include "renderer/pipeline/frame.hpp"
#include "renderer/pipeline/stage_clock.hpp"

namespace handcast::renderer {

/// What a frame is drawn from. Borrowed for FramePainter::draw().
struct FrameDrawing {
  std::span<const DrawnHand> hands;
  Rect region;                     ///< contains all light
  Rect source;                     ///< contains the hands, if they are to be warped
  const WarpGrid* grid = nullptr;  ///< warps the hands from `source` to `region`
  GreyView mask;                   ///< of the hands, projector px; null: there is none
};

/// Steps draw and fill: makes the image of a frame. One thread.
class FramePainter {
 public:
  /// `painter`: draws the frames until it fails (Painter::failure()); after that, and without one,
  /// cpu does.
  FramePainter(std::unique_ptr<Painter> painter, const config::Fill& settings, int width_px,
               int height_px);

  /// Sets colour, device, fill and, if it is shown, the surface of `frame`. Marks the stages.
  void draw(const FrameDrawing& drawing, StageClock& stages, Frame& frame);

  /// See Pipeline::show_surface() and Pipeline::read_back().
  /// @{
  void show_surface(bool on) { shows_surface_ = on; }
  void read_back(Frame& frame);
  /// @}

 private:
  FillCounts paint(const FrameDrawing& drawing, StageClock& stages);
  void add_surface(Frame& frame);
  bool replace_failed();

  std::unique_ptr<Painter> painter_;
  config::Fill settings_;
  int width_px_, height_px_;
  bool shows_surface_ = false;
};

}  // namespace handcast::renderer
