// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/window/monitor.hpp"

struct GLFWmonitor;

namespace handcast::renderer {

/// The monitors of the display server, the primary one first, with GLFW's handles.
struct ConnectedMonitors {
  std::vector<GLFWmonitor*> handles;
  std::vector<Monitor> monitors;  ///< in the order of the handles
};

/// GLFW while it is initialised: at most one object at a time, used by the main thread.
class GlfwLibrary {
 public:
  /// Connects to the display server. Errors: unavailable (no display).
  static Result<std::unique_ptr<GlfwLibrary>> open();
  ~GlfwLibrary();
  GlfwLibrary(const GlfwLibrary&) = delete;
  GlfwLibrary& operator=(const GlfwLibrary&) = delete;

  /// The monitors that are plugged in and have a video mode.
  ConnectedMonitors monitors() const;
  /// The reason of the last failure of a GLFW function.
  static const std::string& last_reason();

 private:
  GlfwLibrary() = default;
};

}  // namespace handcast::renderer
