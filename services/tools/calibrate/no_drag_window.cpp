// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/drag_window.hpp"

namespace handcast::calibrate {

Result<std::unique_ptr<DragWindow>> open_drag_window(int, int, std::function<void()>) {
  return fail(Errc::bad_config, "this build has no window (libglfw3-dev was not found)");
}

}  // namespace handcast::calibrate
