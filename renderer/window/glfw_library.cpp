// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/glfw_library.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "renderer/output/edid.hpp"
#include "renderer/window/x11.hpp"

namespace handcast::renderer {
namespace {

std::string& reason() {
  static std::string text = "no reason given";
  return text;
}

}  // namespace

Result<std::unique_ptr<GlfwLibrary>> GlfwLibrary::open() {
  glfwSetErrorCallback([](int, const char* sentence) { reason() = sentence; });
  if (glfwInit() != GLFW_TRUE)
    return fail(Errc::unavailable,
                fmt::format("no display can be opened ({}); DISPLAY must name an X server that "
                            "this user may use, and XAUTHORITY its key; `handcast install-units` "
                            "writes a unit that has them",
                            last_reason()));
  return std::unique_ptr<GlfwLibrary>(new GlfwLibrary);
}

GlfwLibrary::~GlfwLibrary() { glfwTerminate(); }

ConnectedMonitors GlfwLibrary::monitors() const {
  int count = 0;
  GLFWmonitor** handles = glfwGetMonitors(&count);
  ConnectedMonitors found;
  for (int i = 0; i < count; ++i) {
    const GLFWvidmode* mode = glfwGetVideoMode(handles[i]);
    if (mode == nullptr) continue;
    found.handles.push_back(handles[i]);
    found.monitors.push_back({.output = glfwGetMonitorName(handles[i]),
                              .model = model_of(x11::edid_of(handles[i])),
                              .width_px = mode->width,
                              .height_px = mode->height,
                              .rate_hz = static_cast<double>(mode->refreshRate),
                              .is_primary = i == 0});  // GLFW lists the primary one first
  }
  return found;
}

const std::string& GlfwLibrary::last_reason() { return reason(); }

}  // namespace handcast::renderer
