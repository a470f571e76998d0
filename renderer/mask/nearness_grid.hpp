// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace handcast::renderer {

/// How near the drawn surface of a hand is, on a grid of projector pixels. Nearness is 1 / z - 1 /
/// d, with the depth z and the depth d of the calibration's plane (calib::Calibration), in 1/m.
class NearnessGrid {
 public:
  /// A grid of `columns` x `rows` points, `step_px` apart, the first one at (0, 0).
  NearnessGrid(int columns, int rows, int step_px);

  /// Sets each point to the nearest vertex around it, or, if there is none, to the point beside it
  /// that was set; all to 0 if there are no vertices. The spans have the same length;
  /// `projected_px`: projector px.
  void set(std::span<const glm::vec2> projected_px, std::span<const float> depths_m,
           double plane_m);
  /// The points, row by row.
  std::span<const float> points() const { return points_; }
  /// The range of the points.
  /// @{
  float least() const { return least_; }
  float most() const { return most_; }
  /// @}

 private:
  void spread();

  int columns_, rows_, step_px_;
  std::vector<float> points_;
  float least_ = 0, most_ = 0;
};

}  // namespace handcast::renderer
