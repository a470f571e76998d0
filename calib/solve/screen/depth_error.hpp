// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "calib/calibration.hpp"

namespace handcast::calib {

/// By how many projector pixels one model misses another, over the working volume.
struct ErrorVolume {
  int columns = 0,
      rows = 0;  ///< of a grid over the camera's undistorted image, its corners included
  std::vector<double> depths_m;
  std::vector<double> error_px;  ///< [depth][row][column]

  double at(std::size_t depth, int row, int column) const {
    return error_px[(depth * static_cast<std::size_t>(rows) + static_cast<std::size_t>(row)) *
                        static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(column)];
  }
};
ErrorVolume error_volume(const ProjectorModel& believed, const ProjectorModel& truth,
                         const CameraModel& camera, std::span<const double> depths_m,
                         int columns = 24, int rows = 18);

/// The errors of the coaxial homography of a model, which holds at its plane_m and is used at all
/// depths.
ErrorVolume coaxial_error(const ProjectorModel& model, const CameraModel& camera,
                          std::span<const double> depths_m, int columns = 24, int rows = 18);

/// An ErrorVolume at one depth.
struct DepthError {
  double depth_m = 0;
  double median_px = 0, largest_px = 0;
};
/// One for each depth, over the camera's image.
std::vector<DepthError> depth_error(const ProjectorModel& believed, const ProjectorModel& truth,
                                    const CameraModel& camera, std::span<const double> depths_m);

}  // namespace handcast::calib
