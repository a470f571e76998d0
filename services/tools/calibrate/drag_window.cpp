// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/drag_window.hpp"

#include <cstddef>
#include <utility>

#include "renderer/window/window.hpp"

namespace handcast::calibrate {
namespace {

class GlfwDragWindow final : public DragWindow {
 public:
  GlfwDragWindow(std::unique_ptr<renderer::Window> window, int width_px, int height_px)
      : window_(std::move(window)), picture_(width_px, height_px) {}

  Result<void> show(const std::vector<std::uint8_t>& levels) override {
    auto& pixels = picture_.pixels();
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = 0xff000000u | levels[i] * 0x010101u;
    const auto shown = window_->show(picture_.view(), {0, 0, picture_.width(), picture_.height()});
    if (!shown) return tl::make_unexpected(shown.error());
    return {};
  }

  std::vector<Grip> take_grips() override {
    const glm::dvec2 scale(static_cast<double>(picture_.width()) / window_->width_px(),
                           static_cast<double>(picture_.height()) / window_->height_px());
    std::vector<Grip> grips;
    for (const auto& event : window_->take_pointer())
      grips.push_back({kind_of(event.kind), scale * glm::dvec2(event.x_px, event.y_px)});
    return grips;
  }

 private:
  static Grip::Kind kind_of(renderer::PointerEvent::Kind kind) {
    switch (kind) {
      case renderer::PointerEvent::Kind::press:
        return Grip::Kind::press;
      case renderer::PointerEvent::Kind::release:
        return Grip::Kind::release;
      case renderer::PointerEvent::Kind::move:
        break;
    }
    return Grip::Kind::move;
  }

  std::unique_ptr<renderer::Window> window_;
  renderer::Texture picture_;
};

}  // namespace

Result<std::unique_ptr<DragWindow>> open_drag_window(int width_px, int height_px,
                                                     std::function<void()> when_display_is_lost) {
  auto window = renderer::Window::open({.title = "handcast: drag the corners",
                                        .width_px = width_px / 2,
                                        .height_px = height_px / 2,
                                        .vsync = false,
                                        .when_display_is_lost = std::move(when_display_is_lost)});
  if (!window) return tl::make_unexpected(window.error());
  return std::make_unique<GlfwDragWindow>(std::move(*window), width_px, height_px);
}

}  // namespace handcast::calibrate
