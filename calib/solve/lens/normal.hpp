// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "calib/least_squares/normal_equations.hpp"
#include "calib/solve/lens/solve.hpp"

namespace handcast::calib {

constexpr int kPoseNumbers = 6;  ///< rotation vector, translation
constexpr int kLensNumbers = 9;

/// kLensParameters of a camera.
inline constexpr std::array<double CameraModel::*, kLensNumbers> kLensFields{
    &CameraModel::fx_px, &CameraModel::fy_px, &CameraModel::cx_px,
    &CameraModel::cy_px, &CameraModel::k1,    &CameraModel::k2,
    &CameraModel::p1,    &CameraModel::p2,    &CameraModel::k3};

/// Number of parameters that a model of distortion leaves free; they are the first of
/// kLensParameters.
int free_parameters(Distortion distortion);

void move(Pose& pose, const Eigen::VectorXd& by);

/// The corners of a view in a camera's image, x and y in turn.
struct Seen {
  Eigen::VectorXd residuals;         ///< measured less expected, px
  Eigen::MatrixXd by_pose, by_lens;  ///< derivatives of the expected ones
};
Seen seen_of(const Points& view, const Pose& pose, const CameraModel& camera);

/// The equations of the squared distances of one view: its pose comes first, then the parameters
/// that are free.
NormalEquations normal_of(const Points& view, const Pose& pose, const CameraModel& camera,
                          Distortion distortion);

}  // namespace handcast::calib
