// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace handcast::calib {

/// Points that the tracker has seen at one time, in tracker space, metres. Each index means the same
/// point in all samples: the landmarks of one hand, or one reflector.
struct TrackerSample {
  std::int64_t time_ns = 0;
  std::vector<glm::dvec3> points_m;
};

/// One of these points in a camera image.
struct Sighting {
  std::int64_t time_ns = 0;      ///< middle of the exposure
  int point = 0;                 ///< index into TrackerSample::points_m
  glm::dvec2 undistorted_px{0};  ///< lens distortion removed
  double sigma_px = 1;           ///< standard deviation of x and of y
};

}  // namespace handcast::calib
