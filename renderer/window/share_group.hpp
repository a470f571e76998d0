// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <GLFW/glfw3.h>

#include "renderer/base/device_image.hpp"

namespace handcast::renderer {

/// The share group of a window; none if its context is not one of EGL.
ShareGroup share_group_of(GLFWwindow* window);

}  // namespace handcast::renderer
