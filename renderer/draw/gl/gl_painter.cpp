// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/gl_painter.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "renderer/draw/gl/passes.hpp"

namespace handcast::renderer {
namespace {

using namespace gl;

class Painting final : public GlPainter {
 public:
  Painting(std::unique_ptr<Context> context, glm::ivec2 size_px, const GlOptions& options,
           Drawer drawer, Warper warper, Filler filler)
      : context_(std::move(context)),
        size_px_(size_px),
        reads_back_(options.reads_back && !options.shares),
        is_shared_(options.shares),
        assets_(*context_),
        drawer_(std::move(drawer)),
        warper_(std::move(warper)),
        filler_(std::move(filler)),
        timer_(*context_, options.is_timed),
        depth_(make_image(*context_, GL_DEPTH_COMPONENT32F, size_px.x, size_px.y)),
        frame_(*context_, size_px.x, size_px.y, depth_.name()),
        read_back_(*context_, size_px.x, size_px.y) {}

  void draw(std::span<const DrawnHand> hands, Rect region) override {
    region = region.within(size_px_.x, size_px_.y);
    if (region.empty() || !context_->make_current()) return;
    const auto assets = assets_.find(hands);
    contents_.assign(assets.begin(), assets.end());
    timer_.measure(Pass::draw, [&] { drawer_.draw(hands, assets, region, frame_); });
    read_back_.changed(region);
  }

  void warp(const WarpGrid& grid, Rect from, Rect region) override {
    region = region.within(size_px_.x, size_px_.y);
    if (region.empty() || !context_->make_current()) return;
    if (!moved_)
      moved_ = std::make_unique<Layers>(*context_, size_px_.x, size_px_.y, depth_.name());
    timer_.measure(Pass::warp, [&] {
      warper_.warp(grid, from.within(size_px_.x, size_px_.y), region, frame_, *moved_);
    });
    std::swap(frame_, *moved_);
    read_back_.changed(region);
  }

  FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings,
                  Rect region) override {
    region = region.within(size_px_.x, size_px_.y);
    if (region.empty() || settings.method == config::FillMethod::none || !context_->make_current())
      return {};
    bool is_there = false;
    timer_.measure(Pass::upload, [&] { is_there = filler_.upload(mask, region); });
    if (!is_there) return {};
    timer_.measure(Pass::fill, [&] { filler_.fill(settings, region, contents_, frame_); });
    read_back_.changed(region);
    if (reads_back_) timer_.measure(Pass::read, [&] { read_back_.queue_colour(frame_); });
    wait(*context_, context_->gl().FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    context_->check();
    return context_->lost() ? FillCounts{} : filler_.counts();
  }

  void darken(std::span<const Rect> areas, Rect region) override {
    region = region.within(size_px_.x, size_px_.y);
    if (region.empty() || !context_->make_current()) return;
    for (const auto& area : areas)
      if (const auto dark = area.overlap(region); !dark.empty())
        context_->gl().ClearTexSubImage(frame_.colour.name(), 0, dark.x0, dark.y0, 0, dark.width(),
                                        dark.height(), 1, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    read_back_.changed(region);
  }

  View<const std::uint32_t> colour() override { return read_back_.colour(frame_); }
  std::optional<DeviceImage> device_image() override {
    if (!is_shared_ || !context_->make_current()) return {};
    wait(*context_, context_->gl().FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    context_->check();
    if (context_->lost()) return {};
    return DeviceImage{frame_.colour.name(), size_px_.x, size_px_.y};
  }
  Shown shown(int /*step*/) override { return {read_back_.uv(frame_), read_back_.surface(frame_)}; }

  std::optional<Error> failure() const override {
    if (!context_->lost()) return {};
    return Error{Errc::unavailable,
                 fmt::format("painter gl on {}: {}", context_->gpu().renderer, *context_->lost())};
  }
  const Gpu& gpu() const override { return context_->gpu(); }
  PassTimes pass_times() override { return timer_.take(); }
  std::vector<DevicePass> device_passes() override {
    std::vector<DevicePass> passes;
    const PassTimes times = timer_.take();
    for (std::size_t i = 0; i < times.size(); ++i)
      if (times[i] > 0)
        passes.push_back(
            {static_cast<msg::Stage>(static_cast<std::size_t>(msg::Stage::gpu_draw) + i),
             static_cast<std::int64_t>(1000 * times[i])});
    return passes;
  }

 private:
  std::unique_ptr<Context> context_;  // first: the objects below are of this context
  glm::ivec2 size_px_;
  bool reads_back_, is_shared_;
  AssetCache assets_;
  Drawer drawer_;
  Warper warper_;
  Filler filler_;
  PassTimer timer_;
  Image2d depth_;
  Layers frame_;
  std::unique_ptr<Layers> moved_;  ///< the target of warp(); made by the first one
  ReadBack read_back_;
  std::vector<HandAssets> contents_;  ///< of the drawing, one per hand
};

/// Sets the state that no pass changes.
void set_up(const Functions& gl, glm::ivec2 size_px) {
  gl.Viewport(0, 0, size_px.x, size_px.y);
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl.Enable(GL_DEPTH_CLAMP);
  gl.Enable(GL_SCISSOR_TEST);
  gl.ProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

}  // namespace

Result<std::unique_ptr<GlPainter>> open_gl_painter(int width_px, int height_px,
                                                   const GlOptions& options) {
  const glm::ivec2 size_px(width_px, height_px);
  auto context = Context::open(options.shares);
  if (!context) return tl::make_unexpected(context.error());
  auto drawer = Drawer::create(**context, size_px);
  if (!drawer) return tl::make_unexpected(drawer.error());
  auto warper = Warper::create(**context, size_px);
  if (!warper) return tl::make_unexpected(warper.error());
  auto filler = Filler::create(**context, size_px);
  if (!filler) return tl::make_unexpected(filler.error());
  set_up((*context)->gl(), size_px);
  Context& opened = **context;
  auto painter =
      std::make_unique<Painting>(std::move(*context), size_px, options, std::move(*drawer),
                                 std::move(*warper), std::move(*filler));
  opened.check();
  if (const auto failure = painter->failure()) return tl::make_unexpected(*failure);
  opened.release();  // the painter may be used by another thread
  return painter;
}

}  // namespace handcast::renderer
