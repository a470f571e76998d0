// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "calib/calibration.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/similarity.hpp"

namespace handcast::renderer {

/// Projector pixel -> camera image pixel (homography and lens distortion), as a table once per
/// calibration.
class CameraLookup {
 public:
  explicit CameraLookup(const calib::Calibration& calibration);
  /// `out(x, y) = mask(then_from_now(camera pixel of projector pixel (x, y)))` for the pixels of
  /// `region`; 0 where the camera sees nothing. `then_from_now` takes a camera pixel back to where
  /// the hand's same spot was when the image was exposed.
  void resample(View<const std::uint8_t> mask, Rect region, View<std::uint8_t> out,
                const Similarity& then_from_now = {}) const;
  /// A bounding rectangle of `camera_region` (image px) in projector px.
  Rect to_projector(Rect camera_region) const;

 private:
  /// Eight by eight projector pixels and where their corners are seen (the right and lower ones a
  /// pixel beyond), camera px * 64.
  struct Block {
    int x, y;
    glm::ivec2 top_left, top_right, bottom_left, bottom_right;
  };
  void find_corners(int row, int first, std::vector<glm::ivec2>& corners,
                    const Similarity& then_from_now) const;
  bool resample_uniform(View<const std::uint8_t> mask, const Block& block,
                        View<std::uint8_t> out) const;
  void resample_block(View<const std::uint8_t> mask, const Block& block, Rect part,
                      View<std::uint8_t> out) const;

  int width_ = 0, height_ = 0, columns_ = 0;
  calib::Calibration calibration_;
  std::vector<glm::vec2>
      table_;  ///< of every 8th projector pixel of every 8th row; bilinear in between
};

}  // namespace handcast::renderer
