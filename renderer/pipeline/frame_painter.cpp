// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "ipc/base/log.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/draw/cpu/cpu_painter.hpp"
#include "renderer/pipeline/pipeline.hpp"

namespace handcast::renderer {

using msg::Stage;

FramePainter::FramePainter(std::unique_ptr<Painter> painter, const config::Fill& settings,
                           int width_px, int height_px)
    : painter_(painter ? std::move(painter) : make_cpu_painter(width_px, height_px)),
      settings_(settings),
      width_px_(width_px),
      height_px_(height_px) {}

void FramePainter::draw(const FrameDrawing& drawing, StageClock& stages, Frame& frame) {
  frame.fill = paint(drawing, stages);
  frame.device = painter_->device_image();
  if (!frame.device) frame.colour = painter_->colour();
  if (replace_failed()) {
    frame.device.reset();
    frame.fill = paint(drawing, stages);
    frame.colour = painter_->colour();
  }
  for (const auto& [stage, took_ns] : painter_->device_passes()) stages.add(stage, took_ns);
  if (!frame.device) add_surface(frame);
}

FillCounts FramePainter::paint(const FrameDrawing& drawing, StageClock& stages) {
  if (drawing.region.empty()) return {};
  const bool is_warped = drawing.grid && !drawing.source.empty();
  painter_->draw(drawing.hands, is_warped ? drawing.source : drawing.region);
  stages.mark(Stage::draw);
  if (is_warped) {
    painter_->warp(*drawing.grid, drawing.source, drawing.region);
    stages.mark(Stage::warp);
  }
  FillCounts counts;
  if (drawing.mask.data != nullptr) {
    counts = painter_->fill(drawing.mask, settings_, drawing.region);
    stages.mark(Stage::fill);
  }
  if (!dark_.empty()) painter_->darken(dark_, drawing.region);
  return counts;
}

void FramePainter::add_surface(Frame& frame) {
  if (!shows_surface_ || frame.region.empty()) return;
  const auto shown = painter_->shown(msg::Projection::kShownStep_px);
  frame.uv = shown.uv;
  frame.surface = shown.surface;
}

void FramePainter::read_back(Frame& frame) {
  if (frame.colour.data != nullptr) return;
  frame.colour = painter_->colour();
  add_surface(frame);
}

/// Returns true if the frame must be painted again.
bool FramePainter::replace_failed() {
  const auto failure = painter_->failure();
  if (!failure) return false;
  log::warning("{}; drawing with cpu until the next start", failure->what);
  painter_ = make_cpu_painter(width_px_, height_px_);
  return true;
}

}  // namespace handcast::renderer
