// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <string>

#include "calib/calibration.hpp"

namespace handcast::calib {

/// Where a hand has been in the working volume: 3 x 3 parts of the image, each near and far. One
/// thread.
class VolumeCoverage {
 public:
  /// Copies the sizes of the image.
  explicit VolumeCoverage(const CameraModel& camera);

  /// Adds a place of the hand: where it is in the image, and how far away, by any measure that
  /// grows with the distance, e.g. the inverse of its size in the image.
  void add(const glm::dvec2& undistorted_px, double distance);
  /// The share that is done, 0..1: half for the parts of the image, half for the distances.
  double share() const;
  /// What to do next, as a sentence; "Enough" if nothing is left.
  std::string advice() const;

 private:
  static constexpr int kParts = 3;
  static constexpr int kEnough = 20;  ///< places in a part

  double width_px_, height_px_;
  std::array<int, kParts * kParts> seen_{};  ///< row by row from the top left
  double nearest_ = 0, farthest_ = 0;        ///< 0: none yet
};

}  // namespace handcast::calib
