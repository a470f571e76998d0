// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

struct GLFWmonitor;

/// What GLFW does not offer of X11.
namespace handcast::renderer::x11 {

/// The EDID of a monitor; empty if it has none.
std::vector<std::uint8_t> edid_of(GLFWmonitor* monitor);

/// Calls `reaction` when the connection to the server is lost. If it returns, Xlib ends the process
/// with exit code 1.
void when_display_is_lost(std::function<void()> reaction);

}  // namespace handcast::renderer::x11
