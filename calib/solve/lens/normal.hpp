// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <opencv2/core.hpp>

#include "calib/solve/lens/solve.hpp"

namespace handcast::calib {

using LensMatrix = cv::Matx<double, 9, 9>;
using LensVector = cv::Vec<double, 9>;
using PoseVector = cv::Vec<double, 6>;

/// Number of parameters that a model of distortion leaves free; they are the first of
/// kLensParameters.
int free_parameters(Distortion distortion);

/// The normal equations of the squared distances of one view: how they change with the pose
/// (rotation vector, translation) and with kLensParameters. The equation of a parameter that is not
/// free says that it does not change.
struct Normal {
  cv::Matx66d pose;
  cv::Matx<double, 6, 9> mixed;
  LensMatrix lens;
  PoseVector pose_slope;  ///< the transposed derivative times the residuals
  LensVector lens_slope;
  double squares = 0;  ///< the sum of the squared distances
};
Normal normal_of(const Points& view, const Pose& pose, const CameraModel& camera,
                 Distortion distortion);

/// What a view says about the camera alone, after its pose is eliminated (Schur complement).
struct Statement {
  LensMatrix matrix;
  LensVector slope;
};
Statement statement_of(const Normal& normal);

/// The step of the pose that goes with a step of the camera.
PoseVector pose_step(const Normal& normal, const LensVector& lens_step);

LensVector values_of(const CameraModel& camera);
CameraModel camera_of(const LensVector& values, int width_px, int height_px);

}  // namespace handcast::calib
