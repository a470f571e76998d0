// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/device_image.hpp"
#include "renderer/base/image.hpp"
#include "renderer/output/light.hpp"

namespace handcast::renderer {

/// Draws an image of a GPU to the back buffer of the current context of OpenGL, as write_light()
/// does it on the processor. Used and destroyed while its context is current.
class LevelsShader {
 public:
  LevelsShader();
  ~LevelsShader();
  LevelsShader(const LevelsShader&) = delete;
  LevelsShader& operator=(const LevelsShader&) = delete;

  /// False if the driver has refused the program; then draw() must not be called.
  bool works() const { return works_; }
  /// Draws the region of an image of the same share group, from the whole image to the whole buffer
  /// of `to_width_px` x `to_height_px`, without filtering; black elsewhere.
  void draw(const DeviceImage& image, Rect region, const LightTable& table, int to_width_px,
            int to_height_px);

 private:
  void upload(const LightTable& table);

  unsigned program_ = 0, vertices_ = 0, sampler_ = 0, levels_ = 0;
  bool works_ = false;
  LightTable uploaded_{};
};

}  // namespace handcast::renderer
