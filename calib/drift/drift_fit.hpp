// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <glm/glm.hpp>
#include <optional>

#include "calib/calibration.hpp"
#include "calib/drift/held_hand.hpp"

namespace handcast::calib {

/// A change of the tracker's place: rotation vector (rad) about a pivot, then shift (m), both in
/// the camera's axes.
using Motion = Eigen::Matrix<double, 6, 1>;
using MotionInformation = Eigen::Matrix<double, 6, 6>;

/// What is known of a motion: the inverse of its covariance, and that times the estimate.
struct KnownMotion {
  MotionInformation information = MotionInformation::Zero();
  Motion weighted = Motion::Zero();

  KnownMotion& operator+=(const KnownMotion& other);
  /// The same if the motion has an error of its own, with these standard deviations, besides what
  /// is known: two such are independent.
  KnownMotion with_error(const Motion& deviations) const;
};

/// The motion of the tracker by the held hands of one person. What a moved tracker does to all
/// hands, wherever they are and however they are turned, is the motion; all else is of the person
/// or of the detector, and constant in the axes of hand or bone: each joint's displacement (5 mm),
/// a shift (2 mm), turn (1.4 degrees) and scale (5 %) of the whole hand, a turn of the hand in the
/// tracker's axes (0.7 degrees); or it differs from place to place: shift (0.8 mm) and turn (0.4
/// degrees). All these are unknowns with zero mean and these standard deviations, in one linear
/// least-squares problem that grows hand by hand, and slowly forgets. One thread.
class DriftFit {
 public:
  /// `pivot_m`: camera space, in the middle of the volume.
  DriftFit(const Calibration& calibration, const glm::dvec3& pivot_m);

  /// Adds a hand. False: it was left out, because too few landmarks were seen, or they are nowhere
  /// near its joints.
  bool add(const HeldHand& hand);
  /// The hands that were added.
  int hands() const { return hands_; }
  /// What they say about the motion.
  KnownMotion motion() const;

 private:
  Calibration calibration_;
  glm::dvec3 pivot_m_;
  int hands_ = 0;
  Eigen::MatrixXd information_;  ///< without the prior
  Eigen::VectorXd weighted_;
};

/// The most likely motion and its covariance, if motions of 25 mm and 3 degrees are usual, and of
/// 3 mm along the camera's axis, which landmarks hardly show.
struct LikelyMotion {
  Motion motion = Motion::Zero();
  MotionInformation covariance = MotionInformation::Zero();

  /// The same motion, with the shift of a point that is `arm_m` from the pivot.
  LikelyMotion about(const glm::dvec3& arm_m) const;
};
LikelyMotion likely(const KnownMotion& known);

}  // namespace handcast::calib
