// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/refine.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <set>

#include "calib/solve/tracker/first_pose.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

using Row = Eigen::Matrix<double, 2, 7>;

/// Measured minus projected position in standard deviations, and the derivative of the projected
/// one.
struct Residual {
  Eigen::Vector2d off;
  Row slope;
};

std::optional<Residual> residual_of(const Observations& o, const TimedSighting& s,
                                    const TrackerPose& pose) {
  const auto moving = o.track.at(s.point, s.time_s + pose.offset_s);
  if (!moving) return std::nullopt;
  const auto x = pose.apply(moving->at_m), v = pose.rotation * moving->velocity_m_s;
  if (!(x.z > 0)) return std::nullopt;
  const auto off = (s.px - o.camera.project(x)) / s.sigma;
  Eigen::Matrix<double, 2, 3> projection;
  projection << o.camera.fx_px, 0, -o.camera.fx_px * x.x / x.z,  //
      0, o.camera.fy_px, -o.camera.fy_px * x.y / x.z;
  projection /= x.z * s.sigma;
  Eigen::Matrix<double, 3, 7> motion;    // of the point, by rotation, shift and time
  motion << 0, x.z, -x.y, 1, 0, 0, v.x,  //
      -x.z, 0, x.x, 0, 1, 0, v.y,        //
      x.y, -x.x, 0, 0, 0, 1, v.z;
  return Residual{{off.x, off.y}, projection * motion};
}

/// From the residuals that are shorter than `limit`. The median length of a normally distributed
/// vector in the plane is 1.1774 standard deviations.
double scale_of(const std::vector<Residual>& residuals, double limit) {
  std::vector<double> lengths;
  for (const auto& r : residuals)
    if (const double length = r.off.norm(); length < limit) lengths.push_back(length);
  return std::max(median(std::move(lengths)) / 1.1774, 1e-3);
}

/// A part of the normal equations, in standard deviations, at which the tracker's error is the
/// same.
struct Moment {
  NormalEquations normal = NormalEquations::zero(7);  ///< as if there was no such error
  Curvature second = Curvature::Zero();  ///< what the curvature of the robust cost is less

  void add(const Residual& r, double limit, double unit) {
    const double share = 1 - r.off.squaredNorm() / (limit * limit);
    if (share <= 0) return;
    const Change slope = r.slope.transpose() * r.off;
    normal.matrix.noalias() += unit * share * share * r.slope.transpose() * r.slope;
    normal.slope.noalias() += unit * share * share * slope;
    second.noalias() += 4 * unit * share / (limit * limit) * slope * slope.transpose();
  }
};

/// The error of a moment, as an unknown shift with a standard deviation: its mean and covariance.
struct SharedError {
  Eigen::Vector3d mean;
  Eigen::Matrix3d covariance;
};
SharedError shared_error(const NormalEquations& n, double wander_m) {
  if (wander_m == 0) return {Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  const Eigen::Matrix3d information =
      n.matrix.block<3, 3>(3, 3) + Eigen::Matrix3d::Identity() / (wander_m * wander_m);
  const Eigen::Matrix3d covariance = information.inverse();
  return {covariance * n.slope.segment<3>(3), covariance};
}

/// Whether the points of a time can tell the shared error from their own.
bool has_shared_error(const Observations& o) {
  constexpr std::size_t kLeastPoints = 4;
  std::set<int> points;
  for (const auto& s : o.sightings) points.insert(s.point);
  return points.size() >= kLeastPoints;
}

/// What a moment says about the pose, whatever its shared error is. A shift by that error and one
/// of the pose have the same slopes.
NormalEquations without_shared_error(const NormalEquations& n, const SharedError& error) {
  const Eigen::Matrix<double, 7, 3> across = n.matrix.middleCols<3>(3);
  return {n.matrix - across * error.covariance * across.transpose(), n.slope - across * error.mean};
}

/// The same with the curvature of the robust cost; without its second part if outliers prevail.
/// The gradient is that of step(), so that the sum over all moments is 0 at the solution.
NormalEquations of_robust_cost(const Moment& moment, double wander_m) {
  auto robust = moment.normal;
  robust.matrix -= moment.second;
  if (wander_m == 0) return robust;
  auto plain = without_shared_error(moment.normal, shared_error(moment.normal, wander_m));
  const Eigen::LDLT<Eigen::Matrix3d> solver(robust.matrix.block<3, 3>(3, 3));
  if (!solver.isPositive()) return plain;
  robust = without_shared_error(robust, shared_error(robust, wander_m));
  return {robust.matrix, plain.slope};
}

/// `limit`: sightings that are farther off, in standard deviations of the median one times px,
/// have no weight.
std::vector<Moment> moments_of(const Observations& o, const Refined& refined, double limit) {
  const double begin_s = o.sightings.front().time_s;
  std::vector<Moment> moments;
  for (const auto& s : o.sightings) {
    const auto at = static_cast<std::size_t>((s.time_s - begin_s) / kWander_s);
    if (moments.size() <= at) moments.resize(at + 1);
    if (const auto r = residual_of(o, s, refined.pose))
      moments[at].add(*r, limit, 1 / (refined.scale * refined.scale));
  }
  return moments;
}

/// From the residuals at this pose. `most`: the largest scale.
double scale_at(const Observations& o, const Refined& refined, double most) {
  std::vector<Residual> residuals;
  residuals.reserve(o.sightings.size());
  for (const auto& s : o.sightings)
    if (const auto r = residual_of(o, s, refined.pose)) residuals.push_back(*r);
  return std::min(scale_of(residuals, kTukey * refined.scale), most);
}

}  // namespace

TrackerPose moved(const TrackerPose& pose, const Change& change) {
  const glm::dvec3 turn(change[0], change[1], change[2]), shift(change[3], change[4], change[5]);
  const double angle = glm::length(turn);
  const auto rotation =
      angle > 0 ? glm::mat3_cast(glm::angleAxis(angle, turn / angle)) : glm::dmat3(1);
  return {glm::mat3_cast(glm::normalize(glm::quat_cast(rotation * pose.rotation))),
          rotation * pose.translation_m + shift, pose.offset_s + change[6]};
}

Change change_between(const TrackerPose& a, const TrackerPose& b) {
  const auto rotation = b.rotation * glm::transpose(a.rotation);
  const auto shift = b.translation_m - rotation * a.translation_m;
  Change change;
  change << (rotation[1][2] - rotation[2][1]) / 2, (rotation[2][0] - rotation[0][2]) / 2,
      (rotation[0][1] - rotation[1][0]) / 2, shift.x, shift.y, shift.z, b.offset_s - a.offset_s;
  return change;
}

namespace {

/// One Gauss-Newton step; nothing if the equations are singular. Estimates the shared error anew.
std::optional<Change> step(const Observations& o, Refined& refined, double limit) {
  constexpr double kLeastWander_m = 1e-5, kMostWander_m = 0.005;
  auto sum = NormalEquations::zero(7);
  double squares_m2 = 0, count = 0;
  for (const auto& moment : moments_of(o, refined, limit)) {
    const auto error = shared_error(moment.normal, refined.wander_m);
    sum.add(without_shared_error(moment.normal, error));
    squares_m2 += error.mean.squaredNorm() + error.covariance.trace();
    count += 3;
  }
  if (refined.wander_m > 0)
    refined.wander_m = std::clamp(std::sqrt(squares_m2 / count), kLeastWander_m, kMostWander_m);
  const auto solution = sum.step();
  if (!solution) return std::nullopt;
  Change change = *solution;
  change[6] =
      std::clamp(refined.pose.offset_s + change[6], -kSearch_s, kSearch_s) - refined.pose.offset_s;
  return change.allFinite() ? std::optional(change) : std::nullopt;
}

/// 1 um at 1 m, 1 us.
bool is_small(const Change& change) {
  constexpr double kDone = 1e-6;
  return change.cwiseAbs().maxCoeff() < kDone;
}

constexpr int kMostRounds = 50;

}  // namespace

std::optional<Refined> refine(const Observations& o, const TrackerPose& start) {
  // Larger scales would grow without end on sightings that are anywhere in the image.
  constexpr double kLargestScale = 3 * kNear_px / kTukey, kUsualWander_m = 0.001;
  Refined refined{
      .pose = start, .wander_m = has_shared_error(o) ? kUsualWander_m : 0, .scale = kLargestScale};
  for (int round = 0; round < kMostRounds; ++round) {
    refined.scale = scale_at(o, refined, kLargestScale);
    const auto change = step(o, refined, kTukey * refined.scale);
    if (!change) return std::nullopt;
    refined.pose = moved(refined.pose, *change);
    if (is_small(*change)) break;
  }
  return refined;
}

std::optional<TrackerPose> with_limit(const Observations& o, const Refined& refined,
                                      double factor) {
  auto other = refined;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto change = step(o, other, factor * kTukey * refined.scale);
    if (!change) return std::nullopt;
    other.pose = moved(other.pose, *change);
    other.wander_m = refined.wander_m;
    if (is_small(*change)) break;
  }
  return other.pose;
}

std::vector<NormalEquations> normals_by_time(const Observations& o, const Refined& refined,
                                             double bin_s) {
  std::vector<NormalEquations> normals;
  double begin_s = 0;
  for (const auto& moment : moments_of(o, refined, kTukey * refined.scale)) {
    const auto bin = static_cast<std::size_t>(begin_s / bin_s);
    begin_s += kWander_s;
    if (normals.size() <= bin) normals.resize(bin + 1, NormalEquations::zero(7));
    normals[bin].add(of_robust_cost(moment, refined.wander_m));
  }
  return normals;
}

std::array<std::vector<Measured>, 3> common_errors(const Observations& o, const Refined& refined) {
  std::array<std::vector<Measured>, 3> errors;
  if (refined.wander_m == 0) return errors;
  for (const auto& moment : moments_of(o, refined, kTukey * refined.scale)) {
    const Eigen::LDLT<Eigen::Matrix3d> solver(moment.normal.matrix.block<3, 3>(3, 3));
    const bool is_known = solver.info() == Eigen::Success && solver.vectorD().minCoeff() > 0;
    const Eigen::Matrix3d covariance =
        is_known
            ? Eigen::Matrix3d(solver.solve(Eigen::Matrix3d::Identity()))
            : Eigen::Matrix3d(Eigen::Matrix3d::Constant(std::numeric_limits<double>::infinity()));
    const Eigen::Vector3d shift =
        is_known ? Eigen::Vector3d(covariance * moment.normal.slope.segment<3>(3))
                 : Eigen::Vector3d(Eigen::Vector3d::Zero());
    for (int axis = 0; axis < 3; ++axis)
      errors[static_cast<std::size_t>(axis)].push_back({shift[axis], covariance(axis, axis)});
  }
  return errors;
}

}  // namespace handcast::calib
