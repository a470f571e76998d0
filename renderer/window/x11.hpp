// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

struct GLFWmonitor;

/// What GLFW does not offer of X11.
namespace handcast::renderer::x11 {

/// The EDID of a monitor; empty if it has none.
std::vector<std::uint8_t> edid_of(GLFWmonitor* monitor);

/// Calls `reaction` when the connection to the server is lost. If it returns, Xlib ends the process
/// with exit code 1.
void when_display_is_lost(std::function<void()> reaction);

/// How long the server waits for input until it blanks the screen or switches the monitor off, s;
/// 0: never. Reads the display that the variable DISPLAY names. Empty: no server answers.
struct Blanking {
  int saver_s = 0, power_s = 0;
};
std::optional<Blanking> blanking();

/// Suspends the server's screen saver and power saving, and wakes the monitor. The server ends that
/// when the connection is closed, even by a crash. Returns false if it cannot.
bool keep_awake();

}  // namespace handcast::renderer::x11
