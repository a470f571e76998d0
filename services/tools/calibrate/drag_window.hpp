// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::calibrate {

/// What a person does with the left button of the mouse, in projector pixels.
struct Grip {
  enum class Kind { press, move, release };
  Kind kind = Kind::move;
  glm::dvec2 px{0};
};

/// A window on the operator's monitor with the picture that the projector shows, in which corners
/// are dragged. The projector's own output takes no mouse: it may have no window system, and
/// belongs to another process. Used by the main thread; only one.
class DragWindow {
 public:
  virtual ~DragWindow() = default;

  /// Shows a picture: levels row by row, of the size that the window was opened with. Errors: those
  /// of renderer::Window::show().
  virtual Result<void> show(const std::vector<std::uint8_t>& levels) = 0;
  /// What the mouse has done since the last call.
  virtual std::vector<Grip> take_grips() = 0;
};

/// Opens it for pictures of the projector's size; it is shown at half of it.
/// `when_display_is_lost`: called once before the process ends. Errors: unavailable (no display),
/// bad_config (this build has no windows).
Result<std::unique_ptr<DragWindow>> open_drag_window(int width_px, int height_px,
                                                     std::function<void()> when_display_is_lost);

}  // namespace handcast::calibrate
