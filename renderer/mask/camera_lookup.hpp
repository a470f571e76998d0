// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/similarity.hpp"

namespace handcast::renderer {

/// The map from projector pixels to camera image pixels (homography, parallax and lens distortion),
/// as a table. One thread.
class CameraLookup {
 public:
  /// Projector px between two entries of the table.
  static constexpr int kStep = 8;

  /// Computes the table. `smooth`: resample() interpolates instead of taking the nearest pixel.
  explicit CameraLookup(const calib::Calibration& calibration, bool smooth = false);

  /// Computes the table for another projector with an image of the same size.
  void aim(const calib::ProjectorModel& projector);

  /// Size of the table.
  /// @{
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// @}
  /// Resamples a mask from the camera's image to the projector: out(x, y) =
  /// mask(then_from_now(c)), where c is the camera image pixel of projector pixel (x, y); 0 outside
  /// `mask`. Writes the pixels of `region` (projector px, clipped to the screen). `then_from_now`
  /// maps the image position of a spot on the hand at the target time to the one at the exposure.
  /// `nearness`: of the lit surface, by entry of the table (NearnessGrid::points()); empty: it lies
  /// on the calibration's plane.
  void resample(View<const std::uint8_t> mask, Rect region, View<std::uint8_t> out,
                const Similarity& then_from_now = {}, std::span<const float> nearness = {});
  /// Bounds of `camera_region` (image px) in projector px, not clipped to the screen, for a surface
  /// of this nearness.
  Rect to_projector(Rect camera_region, float nearness = 0) const;

 private:
  /// 8 x 8 projector pixels, and the image positions of its corners in 1/64 camera px. The right
  /// and lower corners are those of the neighbours, a pixel beyond the block.
  struct Block {
    int x, y;
    glm::ivec2 top_left, top_right, bottom_left, bottom_right;
  };
  void find_corners(int row, int first, std::span<glm::ivec2> corners,
                    const Similarity& then_from_now, std::span<const float> nearness) const;
  bool resample_uniform(View<const std::uint8_t> mask, const Block& block,
                        View<std::uint8_t> out) const;
  void resample_block(View<const std::uint8_t> mask, const Block& block, Rect part,
                      View<std::uint8_t> out) const;

  int width_ = 0, height_ = 0, columns_ = 0, rows_ = 0;
  bool smooth_;
  calib::Calibration calibration_;
  /// Image positions of every 8th projector pixel of every 8th row; bilinear in between.
  std::vector<glm::vec2> table_;
  std::vector<glm::vec2> slopes_;  ///< of these positions, by the nearness; empty if coaxial
  std::vector<glm::ivec2> upper_, lower_;  ///< corners of a row of blocks, while it is resampled
};

}  // namespace handcast::renderer
