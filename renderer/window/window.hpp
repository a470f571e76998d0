// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/base/device_image.hpp"
#include "renderer/base/image.hpp"
#include "renderer/output/light.hpp"
#include "renderer/window/monitor.hpp"

namespace handcast::renderer {

/// What a window is opened with.
struct WindowSettings {
  std::string title;
  /// Size of the picture, and of a window that is not full screen.
  /// @{
  int width_px = 640, height_px = 480;
  /// @}
  bool full_screen = false;  ///< on `monitor`, without cursor; otherwise among other windows
  std::string monitor;       ///< see choose_monitor() in monitor.hpp
  bool keeps_awake = false;  ///< the monitor is not blanked, and the desktop not locked, meanwhile
  bool vsync = true;         ///< show() waits for the refresh of the monitor
  /// Called when the connection to the display server is lost; must end the process. Empty: the
  /// process ends with exit code 1.
  std::function<void()> when_display_is_lost;
};

/// The times of a shown picture, CLOCK_MONOTONIC.
struct Shown {
  std::int64_t handed_ns = 0;  ///< when the window system got it
  std::int64_t shown_ns = 0;   ///< when the window system had taken it; with vsync, the refresh
};

/// What a person does with the left button of the mouse.
struct PointerEvent {
  enum class Kind { press, move, release };
  Kind kind = Kind::move;  ///< move: with the button pressed
  /// Pixels of the window, from its top left corner.
  /// @{
  double x_px = 0, y_px = 0;
  /// @}
};

/// The monitors of the display server, the primary one first. Not while a Window is open. Errors:
/// unavailable (no display).
Result<std::vector<Monitor>> list_monitors();

/// A window that shows pictures (X11 and OpenGL by GLFW). It is hidden until the first show(). Only
/// one per process, used by its main thread.
class Window {
 public:
  /// Opens it. Errors: bad_config (several monitors fit), unavailable (no display, no such monitor,
  /// no OpenGL).
  static Result<std::unique_ptr<Window>> open(WindowSettings settings);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Shows a picture of RGBA8, black outside of `region`, scaled to the window. Returns when the
  /// monitor shows it (`vsync`), or when the window system has it. Errors: timeout (the monitor is
  /// unplugged; show() comes back to it when it is there again).
  Result<Shown> show(View<const std::uint32_t> picture, Rect region);

  /// Shows an image of a GPU, of share_group(), with these levels, as soon as the GPU has drawn it;
  /// for the rest like the other show(). Without filtering, if the window has another size.
  Result<Shown> show(const DeviceImage& image, Rect region, const LightTable& table);
  /// Where show() finds images of a GPU; none if it cannot show such images.
  ShareGroup share_group() const;
  /// The monitor of a full-screen window, as it was found last; empty for other windows.
  std::optional<Monitor> monitor() const;
  /// Time from one refresh of the monitor to the next; empty without vsync or a known rate.
  std::optional<std::int64_t> refresh_ns() const;
  /// The characters typed and "Escape", since the last call.
  std::vector<std::string> take_keys();
  /// What the mouse did in this window since the last call, in order.
  std::vector<PointerEvent> take_pointer();
  /// True if the user has closed the window. A full-screen window stays open.
  bool is_closed() const;
  /// Current size in pixels, of a window that the user may have resized.
  /// @{
  int width_px() const;
  int height_px() const;
  /// @}

 private:
  class Screen;
  explicit Window(std::unique_ptr<Screen> screen);
  std::unique_ptr<Screen> screen_;
};

}  // namespace handcast::renderer
