// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/cpu_painter.hpp"

#include <utility>
#include <vector>

#include "renderer/draw/cpu/passes.hpp"

namespace handcast::renderer {
namespace {

using namespace cpu;

/// The texture coordinates of the lit pixels of a drawing.
void find_uv(const FrameBuffer& frame, std::span<const MipChain* const> textures,
             Plane<glm::vec2>& uv) {
  std::vector<Sampler> samplers;
  for (const MipChain* texture : textures) samplers.emplace_back(texture);
  for (int y = 0; y < uv.height(); ++y) {
    const Span lit = frame.lit[static_cast<std::size_t>(y)];
    const SurfaceId* const surface = frame.surface.row(y);
    for (int x = lit.x0; x < lit.x1; ++x)
      if (surface[x] != 0)
        uv.row(y)[x] = samplers[surface[x] / 64].maps()[level_of(frame.shade.row(y)[x])].uv(
            frame.place.row(y)[x]);
  }
}

class CpuPainter final : public Painter {
 public:
  CpuPainter(int width_px, int height_px)
      : width_(width_px),
        height_(height_px),
        target_(width_px, kBand),
        filler_(width_px, height_px),
        frame_(width_px, height_px) {}

  void draw(std::span<const DrawnHand> hands, Rect region) override {
    has_uv_ = false;
    filler_.forget();
    textures_.clear();
    for (const DrawnHand& hand : hands) textures_.push_back(hand.texture);
    region = region.within(width_, height_);
    if (!region.empty()) drawer_.draw(hands, region, target_, frame_);
  }

  void warp(const WarpGrid& grid, Rect from, Rect region) override {
    region = region.within(width_, height_);
    if (region.empty()) return;
    has_uv_ = false;
    if (!moved_) moved_ = std::make_unique<FrameBuffer>(width_, height_);
    warper_.warp(grid, from.within(width_, height_), region, frame_, target_, *moved_);
    std::swap(frame_, *moved_);
  }

  FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings,
                  Rect region) override {
    region = region.within(width_, height_);
    if (region.empty() || settings.method == config::FillMethod::none) return {};
    has_uv_ = false;
    return filler_.fill(mask, settings, region, textures_, frame_);
  }

  View<const std::uint32_t> colour() override { return std::as_const(frame_.colour).view(); }
  View<const glm::vec2> uv() override {
    filler_.add_surfaces(frame_);
    if (!uv_) uv_ = std::make_unique<Plane<glm::vec2>>(width_, height_);
    if (!std::exchange(has_uv_, true)) find_uv(frame_, textures_, *uv_);
    return std::as_const(*uv_).view();
  }
  View<const SurfaceId> surface() override {
    filler_.add_surfaces(frame_);
    return std::as_const(frame_.surface).view();
  }

 private:
  int width_, height_;
  RasterTarget target_;
  Drawer drawer_;
  Warper warper_;
  Filler filler_;
  FrameBuffer frame_;
  std::unique_ptr<FrameBuffer> moved_;  ///< the target of warp(); made by the first one
  std::unique_ptr<Plane<glm::vec2>> uv_;  ///< made by the first call of uv()
  bool has_uv_ = false;                   ///< of the last pass
  std::vector<const MipChain*> textures_;
};

}  // namespace

std::unique_ptr<Painter> make_cpu_painter(int width_px, int height_px) {
  return std::make_unique<CpuPainter>(width_px, height_px);
}

}  // namespace handcast::renderer
