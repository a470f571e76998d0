// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/by_hand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "calib/solve/screen/plane_consensus.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/msg/camera_frame.hpp"
#ifdef HANDCAST_WITH_WINDOW
#include "renderer/window/window.hpp"
#endif

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

constexpr double kInset = 0.1;
constexpr std::array<std::string_view, 4> kNames{"top left", "top right", "bottom right",
                                                 "bottom left"};
constexpr double kLeastStep_px = 0.5, kMostStep_px = 50;

/// Crosses at corners, the chosen one larger.
void draw_crosses(const DraggedCorners& corners, int width_px, int height_px,
                  std::vector<std::uint8_t>& levels) {
  constexpr int kArm_px = 20, kSmallArm_px = 8;
  const auto put = [&](int x, int y) {
    if (x >= 0 && y >= 0 && x < width_px && y < height_px)
      levels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
             static_cast<std::size_t>(x)] = 255;
  };
  for (const auto& corner : corners.corners_px()) {
    // A homography of corners far outside has no sane pixels.
    const glm::ivec2 px(glm::clamp(corner, glm::dvec2(-1e4), glm::dvec2(1e4)));
    const int arm = corner == corners.chosen_px() ? kArm_px : kSmallArm_px;
    for (int along = -arm; along <= arm; ++along)
      for (int across = -1; across <= 1; ++across) {
        put(px.x + along, px.y + across);
        put(px.x + across, px.y + along);
      }
  }
}

/// The camera's image as the homography puts it. Brightened, because infrared images are dark.
void draw(const msg::CameraFrame& frame, const calib::CameraModel& camera,
          const glm::dmat3& camera_from_projector, int width_px, int height_px,
          std::vector<std::uint8_t>& levels) {
  constexpr int kGain = 3;
  auto level = levels.begin();
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x) {
      const auto at = camera_from_projector * glm::dvec3(x, y, 1);
      const auto px = glm::ivec2(glm::round(camera.distort(glm::dvec2(at) / at.z)));
      const bool inside = px.x >= 0 && px.y >= 0 && px.x < static_cast<int>(frame.width_px) &&
                          px.y < static_cast<int>(frame.height_px);
      const int grey = inside ? frame.pixels()[px.y * static_cast<int>(frame.width_px) + px.x] : 0;
      *level++ = static_cast<std::uint8_t>(std::min(255, kGain * grey));
    }
}

/// Obeys the mouse. True if it did something.
bool obey(const std::vector<Grip>& grips, DraggedCorners& corners) {
  for (const auto& grip : grips) switch (grip.kind) {
      case Grip::Kind::press:
        corners.grab(grip.px);
        break;
      case Grip::Kind::move:
        corners.drag_to(grip.px);
        break;
      case Grip::Kind::release:
        corners.drag_to(grip.px);
        corners.drop();
        break;
    }
  return !grips.empty();
}

/// A window for the mouse; null if there is none, which is told.
std::unique_ptr<DragWindow> window_for_mouse(Desk& desk) {
  auto window = open_drag_window(desk.screen.width_px(), desk.screen.height_px(), [&desk] {
    desk.keys.restore();
    desk.own_rig.stop();
    fmt::print(stderr, "\nhandcast calibrate: the display server is gone\n");
    std::_Exit(kExitRetry);
  });
  if (window) return std::move(*window);
  fmt::print(stderr, "  without the mouse: {}\n", printable(window.error().what));
  return nullptr;
}

}  // namespace

DraggedCorners::DraggedCorners(const calib::Calibration& draft) {
  const double w = draft.camera.width_px - 1, h = draft.camera.height_px - 1;
  const double near = kInset, far = 1 - kInset;
  camera_px_ = {
      {{near * w, near * h}, {far * w, near * h}, {far * w, far * h}, {near * w, far * h}}};
  for (std::size_t i = 0; i < 4; ++i) projector_px_[i] = draft.projector.pixel_of(camera_px_[i]);
}

bool DraggedCorners::press(const Key& key) {
  auto& corner = projector_px_[chosen_];
  switch (key.arrow) {
    case Key::Arrow::up:
      corner.y -= step_px_;
      return true;
    case Key::Arrow::down:
      corner.y += step_px_;
      return true;
    case Key::Arrow::left:
      corner.x -= step_px_;
      return true;
    case Key::Arrow::right:
      corner.x += step_px_;
      return true;
    case Key::Arrow::none:
      break;
  }
  if (key.character >= '1' && key.character <= '4')
    chosen_ = static_cast<std::size_t>(key.character - '1');
  else if (key.character == '+')
    step_px_ = std::min(2 * step_px_, kMostStep_px);
  else if (key.character == '-')
    step_px_ = std::max(step_px_ / 2, kLeastStep_px);
  else
    return false;
  return true;
}

bool DraggedCorners::grab(const glm::dvec2& projector_px) {
  const auto nearest = std::ranges::min_element(
      projector_px_, {}, [&](const auto& corner) { return glm::distance(corner, projector_px); });
  if (glm::distance(*nearest, projector_px) > kReach_px) return false;
  chosen_ = static_cast<std::size_t>(nearest - projector_px_.begin());
  held_off_px_ = *nearest - projector_px;
  is_held_ = true;
  return true;
}

void DraggedCorners::drag_to(const glm::dvec2& projector_px) {
  if (is_held_) projector_px_[chosen_] = projector_px + held_off_px_;
}

glm::dmat3 DraggedCorners::homography() const {
  return calib::homography_of_corners(camera_px_, projector_px_);
}

std::string DraggedCorners::state() const {
  return fmt::format("corner {} ({}), steps of {:g} px", chosen_ + 1, kNames[chosen_], step_px_);
}

Result<Outcome> align_by_hand(Desk& desk) {
  if (!desk.keys.has_person())
    return fail(Errc::bad_config,
                "the camera does not see the projector's light, so a person must align it: call "
                "`handcast calibrate` in a terminal");
  auto frames = client::open_stream<msg::CameraFrame>(desk.rig.name, "camera.frames");
  if (!frames) return tl::make_unexpected(frames.error());
  const auto window = window_for_mouse(desk);
  fmt::print(stderr,
             "  The camera does not see the projector's light. Its image is projected: drag its "
             "corners until the image falls\n  onto the things that it shows, at the distance of "
             "the hand{}. 1 2 3 4: corner, arrows: move, + -: step, Enter: done\n",
             window ? ", with the mouse in the window that shows it" : "");
  DraggedCorners corners(desk.draft);
  std::vector<std::uint8_t> levels(static_cast<std::size_t>(desk.screen.width_px()) *
                                   static_cast<std::size_t>(desk.screen.height_px()));
  for (;;) {
    if (auto runs = desk.own_rig.check(); !runs) return tl::make_unexpected(runs.error());
    bool has_moved = window && obey(window->take_grips(), corners);
    while (const auto key = desk.keys.pressed()) {
      if (key->character == '\n') {
        desk.draft.projector.from_camera = corners.homography();
        desk.draft.projector.parallax = {};
        return Outcome{"aligned by hand at four corners",
                       true,
                       {"the light was not measured: it is right at the distance at which it was "
                        "aligned, and elsewhere only if camera and projector are coaxial"}};
      }
      has_moved = corners.press(*key) || has_moved;
    }
    if (has_moved) fmt::print(stderr, "\r  {}\033[K", corners.state());
    const auto frame = frames->latest(Deadline::in(200ms));
    if (!frame && frame.error().code != Errc::timeout) return tl::make_unexpected(frame.error());
    if (!frame) continue;
    draw(**frame, desk.draft.camera, glm::inverse(corners.homography()), desk.screen.width_px(),
         desk.screen.height_px(), levels);
    draw_crosses(corners, desk.screen.width_px(), desk.screen.height_px(), levels);
    desk.screen.show([&](std::uint8_t* to) { std::ranges::copy(levels, to); });
    if (window)
      if (const auto shown = window->show(levels); !shown)
        return tl::make_unexpected(shown.error());
  }
}

#ifdef HANDCAST_WITH_WINDOW
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
#else
Result<std::unique_ptr<DragWindow>> open_drag_window(int, int, std::function<void()>) {
  return fail(Errc::bad_config, "this build has no window (libglfw3-dev was not found)");
}
#endif

}  // namespace handcast::calibrate
