// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "calib/solve/screen/homography_fit.hpp"
#include "calib/solve/screen/projective_fit.hpp"

/// Errors and intervals, which the fits of this folder share.
namespace handcast::calib {

/// The errors of a model on observations.
ErrorsPx errors_of(const ProjectorModel& model, std::span<const Observation> observations);
ErrorsPx errors_of(const std::vector<double>& residuals_px);

/// The residuals of the observations by fits without their parts of the image: the parts are dealt
/// to five folds so that neighbours are in different ones. `views`: the blocks are views *
/// kImageBlocks.
std::vector<double> held_out_by_blocks(const Replicas& replicas,
                                       std::span<const Observation> observations, int views);

/// The corners of the projector's picture in the camera's undistorted pixels, clockwise from the
/// top left, by the homography that holds at plane_m.
std::array<glm::dvec2, 4> corners_in_camera(const ProjectorModel& model,
                                            const glm::ivec2& projector_px);

/// Models of 200 bootstrap samples of the blocks that hold observations, and, from five views on,
/// of the views first. Samples that do not determine the model are left out.
class Bootstrap {
 public:
  Bootstrap(const Replicas& replicas, std::span<const Observation> observations, int views,
            Unknowns unknowns);
  /// Half the width of the 95 % interval of a function of the model: 1.96 standard deviations of
  /// its replicates. They are widened by the square root of blocks / (blocks - unknowns), since the
  /// fit follows the errors of its own blocks.
  double interval(const std::function<double(const ProjectorModel&)>& value) const;
  /// interval() of each coordinate of the four corners_in_camera().
  std::array<glm::dvec2, 4> corner_intervals(const glm::ivec2& projector_px) const;

 private:
  std::vector<ProjectorModel> models_;
  double widening_ = 1;
};

}  // namespace handcast::calib
