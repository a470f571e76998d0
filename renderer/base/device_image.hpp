// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::renderer {

/// A share group of OpenGL, whose contexts have their textures in common: an EGLDisplay and one of
/// the EGLContexts. Both null: none.
struct ShareGroup {
  void* display = nullptr;
  void* context = nullptr;

  explicit operator bool() const { return context != nullptr; }
};

/// An image in the memory of a GPU: a texture of a share group. R32UI, the RGBA8 of
/// Painter::colour(); row 0 is the top row.
struct DeviceImage {
  unsigned texture = 0;
  int width_px = 0, height_px = 0;
};

}  // namespace handcast::renderer
