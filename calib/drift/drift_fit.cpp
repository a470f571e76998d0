// SPDX-License-Identifier: Apache-2.0
#include "calib/drift/drift_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr Eigen::Index kMotion = 6;
/// The unknowns, after the motion: shift and turn of the hand in its own axes, its turn in the
/// tracker's, its scale, and the displacement of each joint. The last 6 are of one place.
/// @{
constexpr Eigen::Index kShift = kMotion, kTurn = kShift + 3, kTrackerTurn = kTurn + 3,
                       kScale = kTrackerTurn + 3, kJoints = kScale + 1,
                       kLasting = kJoints + 3 * Eigen::Index{kHandPoints}, kPlace = kLasting,
                       kAll = kPlace + 6;
/// @}
constexpr double kShift_m = 0.002, kTurn_rad = 0.025, kTrackerTurn_rad = 0.012, kScaleShare = 0.05,
                 kJoint_m = 0.005, kPlace_m = 0.0008, kPlaceTurn_rad = 0.007;
/// Of a landmark: what is left of a detector's error after the mean over half a second.
constexpr double kLeastSigma_px = 3;
/// Landmarks farther from the median offset count less.
constexpr double kFar_px = 12;
/// A hand whose median offset is larger belongs to something else.
constexpr double kNowhere_px = 150;
/// Of what earlier hands said, with each new one: a tracker that moves meanwhile is noticed.
constexpr double kInformationKept = 0.985;
constexpr double kNearest_m = 0.05;
constexpr std::size_t kLeastLandmarks = 10;

using Wide = Eigen::Matrix<double, 2, kAll>;

Eigen::Vector3d in_eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
Eigen::Matrix3d in_eigen(const glm::dmat3& m) {
  Eigen::Matrix3d matrix;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) matrix(r, c) = m[c][r];
  return matrix;
}

/// How a point moves by a rotation vector: w x arm.
Eigen::Matrix3d by_turn(const glm::dvec3& arm) {
  Eigen::Matrix3d matrix;
  matrix << 0, arm.z, -arm.y, -arm.z, 0, arm.x, arm.y, -arm.x, 0;
  return matrix;
}

Eigen::Matrix<double, kLasting, 1> prior_of_person() {
  Eigen::Matrix<double, kLasting, 1> deviations;
  deviations.setConstant(kJoint_m);
  deviations.segment<3>(kShift).setConstant(kShift_m);
  deviations.segment<3>(kTurn).setConstant(kTurn_rad);
  deviations.segment<3>(kTrackerTurn).setConstant(kTrackerTurn_rad);
  deviations[kScale] = kScaleShare;
  Eigen::Matrix<double, kLasting, 1> information = deviations.array().square().inverse();
  information.head<kMotion>().setZero();
  return information;
}

/// A landmark and the joint that it should show.
struct Offset {
  std::size_t point;
  glm::dvec3 camera_m;
  glm::dvec2 px;  ///< seen minus expected
  double sigma_px;
};

std::vector<Offset> offsets_of(const Calibration& calibration, const HeldHand& hand) {
  std::vector<Offset> offsets;
  for (std::size_t i = 0; i < kHandPoints; ++i) {
    const auto& seen = hand.seen[i];
    const glm::dvec3 at(calibration.camera_from_tracker * glm::dvec4(hand.tracked[i].at_m, 1));
    if (!(seen.sigma_px > 0) || !(at.z > kNearest_m)) continue;
    const auto off_px = seen.undistorted_px - calibration.camera.project(at);
    if (std::isfinite(off_px.x + off_px.y + seen.sigma_px))
      offsets.push_back({i, at, off_px, std::hypot(kLeastSigma_px, seen.sigma_px)});
  }
  return offsets;
}

glm::dvec2 median_of(const std::vector<Offset>& offsets) {
  std::vector<double> right_px, down_px;
  for (const auto& offset : offsets) {
    right_px.push_back(offset.px.x);
    down_px.push_back(offset.px.y);
  }
  return {median(std::move(right_px)), median(std::move(down_px))};
}

/// How a landmark moves in the image by each unknown, px.
Wide slopes_of(const Calibration& calibration, const HeldHand& hand, const Offset& offset,
               const glm::dvec3& pivot_m) {
  const auto& camera = calibration.camera;
  const auto& at = offset.camera_m;
  Eigen::Matrix<double, 2, 3> project;
  project << camera.fx_px, 0, -camera.fx_px * at.x / at.z, 0, camera.fy_px,
      -camera.fy_px * at.y / at.z;
  project /= at.z;
  const glm::dmat3 camera_from_tracker(calibration.camera_from_tracker);
  const glm::dvec3 wrist(calibration.camera_from_tracker * glm::dvec4(hand.tracked[0].at_m, 1));
  const auto arm = at - wrist;
  const auto hand_axes = in_eigen(camera_from_tracker * hand.tracked[0].axes);
  const auto joint_axes = in_eigen(camera_from_tracker * hand.tracked[offset.point].axes);
  Wide slopes = Wide::Zero();
  slopes.block<2, 3>(0, 0) = project * by_turn(at - pivot_m);
  slopes.block<2, 3>(0, 3) = project;
  slopes.block<2, 3>(0, kShift) = project * hand_axes;
  slopes.block<2, 3>(0, kTurn) = project * by_turn(arm) * hand_axes;
  slopes.block<2, 3>(0, kTrackerTurn) = project * by_turn(arm);
  slopes.col(kScale) = project * in_eigen(arm);
  slopes.block<2, 3>(0, kJoints + 3 * static_cast<Eigen::Index>(offset.point)) =
      project * joint_axes;
  slopes.block<2, 3>(0, kPlace) = project;
  slopes.block<2, 3>(0, kPlace + 3) = project * by_turn(arm);
  return slopes;
}

/// What is known of the first unknowns of a problem if the rest is anything.
template <class Information, class Weighted>
void leave_out_rest(Eigen::Index first, const Information& information, const Weighted& weighted,
                    Eigen::MatrixXd& kept, Eigen::VectorXd& kept_weighted) {
  const Eigen::Index rest = information.rows() - first;
  const Eigen::MatrixXd across = information.topRightCorner(first, rest);
  const Eigen::LDLT<Eigen::MatrixXd> solver(information.bottomRightCorner(rest, rest));
  kept = information.topLeftCorner(first, first) - across * solver.solve(across.transpose());
  kept_weighted = weighted.head(first) - across * solver.solve(weighted.tail(rest));
}

}  // namespace

KnownMotion& KnownMotion::operator+=(const KnownMotion& other) {
  information += other.information;
  weighted += other.weighted;
  return *this;
}

/// (I^-1 + E)^-1 without the inverse of I, which may be singular: I - I (I + E^-1)^-1 I.
KnownMotion KnownMotion::with_error(const Motion& deviations) const {
  const MotionInformation error = deviations.array().square().inverse().matrix().asDiagonal();
  const MotionInformation less =
      information * (information + error).ldlt().solve(MotionInformation::Identity());
  return {information - less * information, weighted - less * weighted};
}

DriftFit::DriftFit(const Calibration& calibration, const glm::dvec3& pivot_m)
    : calibration_(calibration),
      pivot_m_(pivot_m),
      information_(Eigen::MatrixXd::Zero(kLasting, kLasting)),
      weighted_(Eigen::VectorXd::Zero(kLasting)) {}

bool DriftFit::add(const HeldHand& hand) {
  const auto offsets = offsets_of(calibration_, hand);
  if (offsets.size() < kLeastLandmarks) return false;
  const auto median_px = median_of(offsets);
  if (glm::length(median_px) > kNowhere_px) return false;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kAll, kAll);
  Eigen::VectorXd weighted = Eigen::VectorXd::Zero(kAll);
  information.diagonal().segment<3>(kPlace).setConstant(1 / (kPlace_m * kPlace_m));
  information.diagonal().tail<3>().setConstant(1 / (kPlaceTurn_rad * kPlaceTurn_rad));
  for (const auto& offset : offsets) {
    const double far = glm::distance(offset.px, median_px) / kFar_px;
    const double weight = 1 / (offset.sigma_px * offset.sigma_px * (1 + far * far));
    const auto slopes = slopes_of(calibration_, hand, offset, pivot_m_);
    information.noalias() += weight * slopes.transpose() * slopes;
    weighted.noalias() += weight * slopes.transpose() * Eigen::Vector2d(offset.px.x, offset.px.y);
  }
  Eigen::MatrixXd kept;
  Eigen::VectorXd kept_weighted;
  leave_out_rest(kLasting, information, weighted, kept, kept_weighted);
  information_ = kInformationKept * information_ + kept;
  weighted_ = kInformationKept * weighted_ + kept_weighted;
  ++hands_;
  return true;
}

KnownMotion DriftFit::motion() const {
  Eigen::MatrixXd kept;
  Eigen::VectorXd weighted;
  Eigen::MatrixXd information = information_;
  information.diagonal() += prior_of_person();
  leave_out_rest(kMotion, information, weighted_, kept, weighted);
  return {kept, weighted};
}

LikelyMotion LikelyMotion::about(const glm::dvec3& arm_m) const {
  MotionInformation change = MotionInformation::Identity();
  change.bottomLeftCorner<3, 3>() = by_turn(arm_m);
  return {change * motion, change * covariance * change.transpose()};
}

LikelyMotion likely(const KnownMotion& known) {
  constexpr double kUsual_rad = 0.052, kUsual_m = 0.025, kUsualDepth_m = 0.003;
  Motion deviations;
  deviations << kUsual_rad, kUsual_rad, kUsual_rad, kUsual_m, kUsual_m, kUsualDepth_m;
  MotionInformation information = known.information;
  information.diagonal().array() += deviations.array().square().inverse();
  LikelyMotion likely;
  likely.covariance = information.ldlt().solve(MotionInformation::Identity());
  likely.motion = likely.covariance * known.weighted;
  return likely;
}

}  // namespace handcast::calib
