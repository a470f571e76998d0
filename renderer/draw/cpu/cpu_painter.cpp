// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/cpu_painter.hpp"

#include <vector>

#include "renderer/draw/cpu/passes.hpp"

namespace handcast::renderer {
namespace {

using namespace cpu;

class CpuPainter final : public Painter {
 public:
  CpuPainter(int width_px, int height_px)
      : width_(width_px),
        height_(height_px),
        target_(width_px, kBand),
        filler_(width_px, height_px),
        frame_(width_px, height_px) {}

  void draw(std::span<const DrawnHand> hands, Rect region) override {
    textures_.clear();
    for (const DrawnHand& hand : hands) textures_.push_back(hand.texture);
    region = region.within(width_, height_);
    if (!region.empty()) drawer_.draw(hands, region, target_, frame_);
  }

  void warp(const WarpGrid& grid, Rect from, Rect region) override {
    region = region.within(width_, height_);
    if (region.empty()) return;
    if (!moved_) moved_ = std::make_unique<FrameBuffer>(width_, height_);
    warper_.warp(grid, from.within(width_, height_), region, frame_, target_, *moved_);
    std::swap(frame_, *moved_);
  }

  FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings,
                  Rect region) override {
    region = region.within(width_, height_);
    if (region.empty() || settings.method == config::FillMethod::none) return {};
    return filler_.fill(mask, settings, region, textures_, frame_);
  }

  View<const std::uint32_t> colour() override { return std::as_const(frame_.colour).view(); }
  View<const glm::vec2> uv() override { return std::as_const(frame_.uv).view(); }
  View<const SurfaceId> surface() override { return std::as_const(frame_.surface).view(); }

 private:
  int width_, height_;
  RasterTarget target_;
  Drawer drawer_;
  Warper warper_;
  Filler filler_;
  FrameBuffer frame_;
  std::unique_ptr<FrameBuffer> moved_;  ///< the target of warp(); made by the first one
  std::vector<const MipChain*> textures_;
};

}  // namespace

std::unique_ptr<Painter> make_cpu_painter(int width_px, int height_px) {
  return std::make_unique<CpuPainter>(width_px, height_px);
}

}  // namespace handcast::renderer
