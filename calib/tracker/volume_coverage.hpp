// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <string>

#include "calib/calibration.hpp"

namespace handcast::calib {

/// How much of the working volume the hand has visited: 3 x 3 fields of the image times 3 depths.
/// For live advice while the points for fit_tracker() are collected. One thread.
class VolumeCoverage {
 public:
  /// `rough_camera_from_tracker`: an earlier or nominal calibration, from which the depth is taken;
  /// 10 cm and 10 degrees do not matter. The depths reach from `near_m` to `far_m`, near < far.
  VolumeCoverage(const CameraModel& camera, const glm::dmat4& rough_camera_from_tracker,
                 double near_m, double far_m);

  /// A point that camera and tracker saw at the same time. Points outside the image, nearer or
  /// farther than the volume, or with numbers that are not finite do not count.
  void add(const glm::dvec2& undistorted_px, const glm::dvec3& tracker_m);
  /// Of the cells, those with at least 30 points: 0 to 1.
  double share() const;
  /// Where to move the hand next, as a sentence; that the volume is covered if it is.
  std::string advice() const;

 private:
  static constexpr int kSide = 3, kDepths = 3, kEnough = 30;

  bool covered(int depth, int row, int column) const {
    const int cell = (depth * kSide + row) * kSide + column;
    return counts_[static_cast<std::size_t>(cell)] >= kEnough;
  }

  CameraModel camera_;
  glm::dmat4 rough_;
  double near_m_, far_m_;
  std::array<int, kSide * kSide * kDepths> counts_{};
};

}  // namespace handcast::calib
