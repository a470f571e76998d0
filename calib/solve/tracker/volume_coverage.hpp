// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/image_fields.hpp"

namespace handcast::calib {

/// A point of a hand that camera and tracker saw at the same time.
struct SeenPoint {
  glm::dvec2 undistorted_px;
  glm::dvec3 tracker_m;  ///< in the tracker's own frame
};

/// The depth of a hand by its size: the camera's focal length times what the tracker says is
/// between two points, over what the image shows. Pairs that point towards the camera look shorter,
/// so a low quantile counts; of a hand seen from its edge the depth is some cm too large. 0 if the
/// points are too few, too close together, or no numbers.
double depth_by_size_m(const CameraModel& camera, std::span<const SeenPoint> hand);

/// How much of the working volume the hand has visited: 3 x 3 fields of the image times 3 depths.
/// For live advice while the points for fit_tracker() are collected. One thread.
class VolumeCoverage {
 public:
  /// The depths reach from `near_m` to `far_m`, near < far.
  VolumeCoverage(const CameraModel& camera, double near_m, double far_m);

  /// The points of one hand in one image, each at its own pixel and at the hand's depth by its
  /// size, which needs no earlier calibration. Points outside the image, nearer or farther than the
  /// volume, or with numbers that are not finite do not count.
  void add(std::span<const SeenPoint> hand);
  /// One point at a known depth, e.g. a reflector.
  void add(const glm::dvec2& undistorted_px, double depth_m);
  /// Of the cells, those with at least 30 points: 0 to 1.
  double share() const;
  /// Where to move the hand next, as a sentence; that the volume is covered if it is.
  std::string advice() const;

 private:
  static constexpr int kDepths = 3, kEnough = 30;

  CameraModel camera_;
  double near_m_, far_m_;
  std::vector<ImageFields> fields_;  ///< of each depth, the nearest first
};

}  // namespace handcast::calib
