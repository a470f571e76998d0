// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/share_group.hpp"

#ifdef HANDCAST_WITH_EGL
#define GLFW_EXPOSE_NATIVE_EGL
#include <GLFW/glfw3native.h>
#endif

namespace handcast::renderer {

ShareGroup share_group_of([[maybe_unused]] GLFWwindow* window) {
#ifdef HANDCAST_WITH_EGL
  if (glfwGetWindowAttrib(window, GLFW_CONTEXT_CREATION_API) == GLFW_EGL_CONTEXT_API)
    return {glfwGetEGLDisplay(), glfwGetEGLContext(window)};
#endif
  return {};
}

}  // namespace handcast::renderer
