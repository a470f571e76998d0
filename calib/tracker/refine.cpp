// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "calib/tracker/first_pose.hpp"

namespace handcast::calib {
namespace {

using Row = Eigen::Matrix<double, 2, 7>;

/// Measured minus projected position in standard deviations, and the derivative of the projected
/// one.
struct Residual {
  Eigen::Vector2d off;
  Row slope;
};

std::optional<Residual> residual_of(const Observations& o, const Observation& s, const Pose& pose) {
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
  return std::max(percentile_of(std::move(lengths), 0.5) / 1.1774, 1e-3);
}

}  // namespace

Pose moved(const Pose& pose, const Change& change) {
  const glm::dvec3 turn(change[0], change[1], change[2]), shift(change[3], change[4], change[5]);
  const double angle = glm::length(turn);
  const auto rotation =
      angle > 0 ? glm::mat3_cast(glm::angleAxis(angle, turn / angle)) : glm::dmat3(1);
  return {glm::mat3_cast(glm::normalize(glm::quat_cast(rotation * pose.rotation))),
          rotation * pose.translation_m + shift, pose.offset_s + change[6]};
}

Change change_between(const Pose& a, const Pose& b) {
  const auto rotation = b.rotation * glm::transpose(a.rotation);
  const auto shift = b.translation_m - rotation * a.translation_m;
  Change change;
  change << (rotation[1][2] - rotation[2][1]) / 2, (rotation[2][0] - rotation[0][2]) / 2,
      (rotation[0][1] - rotation[1][0]) / 2, shift.x, shift.y, shift.z, b.offset_s - a.offset_s;
  return change;
}

std::optional<Refined> refine(const Observations& o, const Pose& start,
                              std::optional<double> fixed_scale) {
  constexpr int kMostRounds = 50;
  // Larger scales would grow without end on sightings that are anywhere in the image.
  constexpr double kLargestScale = 3 * kNear_px / kTukey;
  Refined refined{start, fixed_scale.value_or(kLargestScale)};
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<Residual> residuals;
    residuals.reserve(o.sightings.size());
    for (const auto& s : o.sightings)
      if (const auto r = residual_of(o, s, refined.pose)) residuals.push_back(*r);
    if (!fixed_scale)
      refined.scale = std::min(scale_of(residuals, kTukey * refined.scale), kLargestScale);
    const double limit = kTukey * refined.scale;
    Curvature curvature = Curvature::Zero();
    Change gradient = Change::Zero();
    for (const auto& r : residuals) {
      const double share = 1 - r.off.squaredNorm() / (limit * limit);
      if (share <= 0) continue;
      curvature.noalias() += share * share * r.slope.transpose() * r.slope;
      gradient.noalias() += share * share * r.slope.transpose() * r.off;
    }
    const Eigen::LDLT<Curvature> solver(curvature);
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 0)) return std::nullopt;
    Change change = solver.solve(gradient);
    change[6] = std::clamp(refined.pose.offset_s + change[6], -kSearch_s, kSearch_s) -
                refined.pose.offset_s;
    if (!change.allFinite()) return std::nullopt;
    refined.pose = moved(refined.pose, change);
    // 1 um at 1 m, 1 us
    constexpr double kDone = 1e-6;
    if (change.cwiseAbs().maxCoeff() < kDone) break;
  }
  return refined;
}

std::vector<Normal> normals_by_time(const Observations& o, const Refined& refined, double bin_s) {
  const double begin_s = o.sightings.front().time_s, limit = kTukey * refined.scale;
  std::vector<Normal> normals;
  for (const auto& s : o.sightings) {
    const auto bin = static_cast<std::size_t>((s.time_s - begin_s) / bin_s);
    if (normals.size() <= bin) normals.resize(bin + 1);
    const auto r = residual_of(o, s, refined.pose);
    if (!r) continue;
    const double share = 1 - r->off.squaredNorm() / (limit * limit);
    if (share <= 0) continue;
    // Of limit^2 / 6 (1 - share^3), in units of the scale.
    const double unit = 1 / (refined.scale * refined.scale);
    const Change slope = r->slope.transpose() * r->off;
    normals[bin].curvature += unit * (share * share * r->slope.transpose() * r->slope -
                                      4 * share / (limit * limit) * slope * slope.transpose());
    normals[bin].gradient += unit * share * share * slope;
  }
  return normals;
}

}  // namespace handcast::calib
