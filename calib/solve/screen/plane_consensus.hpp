// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/projector_model.hpp"
#include "calib/solve/screen/projective_fit.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calib {

/// The homography that maps four undistorted camera pixels to four projector pixels, each in the
/// same order: a start by hand. Not finite if three of the points lie on a line.
glm::dmat3 homography_of_corners(const std::array<glm::dvec2, 4>& camera_px,
                                 const std::array<glm::dvec2, 4>& projector_px);

/// Parts into which an area of the image is divided for held-out errors and the bootstrap.
constexpr int kBlocksAcross = 8, kBlocksDown = 6, kImageBlocks = kBlocksAcross * kBlocksDown;
/// The part that holds a pixel; pixels outside the area belong to the parts at its border.
int block_of(const glm::dvec2& px, const glm::dvec2& first_px, const glm::dvec2& last_px);

/// The points of one plane that agree with each other.
struct PlaneConsensus {
  ProjectorModel model;              ///< a homography, fitted to the inliers
  std::vector<Observation> inliers;  ///< blocks: of the area that the points fill
  double share = 0;                  ///< of all points
};

/// Finds the homography that most points agree with (RANSAC, Fischler and Bolles 1981), then the
/// points within 4 standard deviations of it, which come from the median residual; points that are
/// not finite are no inliers. The inverse depth of the inliers is 1 / plane_m.
/// Errors: bad_data (too few points, less than 60 % agree, or they lie on a line).
Result<PlaneConsensus> plane_consensus(std::span<const Correspondence> points,
                                       const CameraModel& camera, double plane_m);

}  // namespace handcast::calib
