// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/cpu_painter.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "renderer/draw/cpu/passes.hpp"

namespace handcast::renderer {
namespace {

using namespace cpu;

/// The texture coordinates of the lit pixels of a drawing whose coordinates are multiples of
/// `step`.
void find_uv(const FrameBuffer& frame, std::span<const Sampler> samplers, int step,
             Plane<glm::vec2>& uv) {
  for (int y = 0; y < uv.height(); y += step) {
    const Span lit = frame.lit[static_cast<std::size_t>(y)];
    const SurfaceId* const surface = frame.surface.row(y);
    for (int x = (lit.x0 + step - 1) / step * step; x < lit.x1; x += step)
      if (surface[x] != 0)
        uv.row(y)[x] = samplers[surface[x] / 64].maps()[level_of(frame.shade.row(y)[x])].uv(
            frame.place.row(y)[x]);
  }
}

class CpuPainter final : public Painter {
 public:
  CpuPainter(int width_px, int height_px, int threads)
      : width_(width_px),
        height_(height_px),
        crew_(threads - 1),
        targets_(static_cast<std::size_t>(crew_.size()), RasterTarget(width_px, kBand)),
        filler_(width_px, height_px),
        frame_(width_px, height_px) {
    samplers_.reserve(4);
  }

  void draw(std::span<const DrawnHand> hands, Rect region) override {
    shown_step_ = 0;
    filler_.forget();
    samplers_.clear();
    for (const DrawnHand& hand : hands) samplers_.emplace_back(hand.picture, hand.mesh->uv);
    region = region.within(width_, height_);
    if (!region.empty()) drawer_.draw(hands, samplers_, region, crew_, targets_, frame_);
  }

  void warp(const WarpGrid& grid, Rect from, Rect region) override {
    region = region.within(width_, height_);
    if (region.empty()) return;
    shown_step_ = 0;
    if (!moved_) moved_ = std::make_unique<FrameBuffer>(width_, height_);
    warper_.warp(grid, from.within(width_, height_), region, frame_, targets_.front(), *moved_);
    std::swap(frame_, *moved_);
  }

  FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings,
                  Rect region) override {
    region = region.within(width_, height_);
    if (region.empty() || settings.method == config::FillMethod::none) return {};
    shown_step_ = 0;
    return filler_.fill(mask, settings, region, samplers_, frame_);
  }

  void darken(std::span<const Rect> areas, Rect region) override {
    region = region.within(width_, height_);
    for (const auto& area : areas) {
      const auto dark = area.overlap(region);
      for (int y = dark.y0; y < dark.y1; ++y)
        std::fill(frame_.colour.row(y) + dark.x0, frame_.colour.row(y) + dark.x1, 0);
    }
  }

  View<const std::uint32_t> colour() override { return std::as_const(frame_.colour).view(); }
  Shown shown(int step) override {
    if (shown_step_ == 0 || step % shown_step_ != 0) {
      shown_step_ = step;
      filler_.add_surfaces(step, frame_);
      if (!uv_) uv_ = std::make_unique<Plane<glm::vec2>>(width_, height_);
      find_uv(frame_, samplers_, step, *uv_);
    }
    return {std::as_const(*uv_).view(), std::as_const(frame_.surface).view()};
  }

 private:
  int width_, height_;
  Crew crew_;
  std::vector<RasterTarget> targets_;  ///< one for each thread of the crew
  Drawer drawer_;
  Warper warper_;
  Filler filler_;
  FrameBuffer frame_;
  std::unique_ptr<FrameBuffer> moved_;    ///< the target of warp(); made by the first one
  std::unique_ptr<Plane<glm::vec2>> uv_;  ///< made by the first call of shown()
  int shown_step_ = 0;                    ///< of shown() since the last pass; 0: not called
  std::vector<Sampler> samplers_;
};

}  // namespace

std::unique_ptr<Painter> make_cpu_painter(int width_px, int height_px, int threads) {
  return std::make_unique<CpuPainter>(width_px, height_px, threads);
}

}  // namespace handcast::renderer
