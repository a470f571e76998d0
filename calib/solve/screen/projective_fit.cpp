// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/projective_fit.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace handcast::calib {
namespace {

using Normal = Eigen::Matrix<double, 11, 11>;
using Vector = Eigen::Matrix<double, 11, 1>;
using Scaling = Replicas::Scaling;

constexpr int kMostSteps = 30;
constexpr double kDone = 1e-10;  ///< relative decrease of the sum of squares
constexpr double kFirstDamping = 1e-4, kMostDamping = 1e6;
/// Of a diagonal element before and after elimination: below, the equations are singular.
constexpr double kSingular = 1e-9;

/// Maps the points to mean 0 and a mean distance of about 1.
template <class Position>
glm::dmat3 centring(std::span<const Observation> observations, Position&& position) {
  const auto count = static_cast<double>(observations.size());
  glm::dvec2 mean(0);
  for (const auto& observation : observations) mean += position(observation) / count;
  double square = 0;
  for (const auto& observation : observations) {
    const glm::dvec2 away = position(observation) - mean;
    square += glm::dot(away, away) / count;
  }
  const double scale = 1 / std::sqrt(square);
  return {scale, 0, 0, 0, scale, 0, -scale * mean.x, -scale * mean.y, 1};
}

Scaling scaling_of(std::span<const Observation> observations, double plane_m) {
  Scaling scaling;
  scaling.camera = centring(observations, [](const auto& o) { return o.camera_px; });
  scaling.projector = centring(observations, [](const auto& o) { return o.projector_px; });
  double square = 0;
  for (const auto& observation : observations) {
    const double lift = observation.inverse_depth - 1 / plane_m;
    square += lift * lift / static_cast<double>(observations.size());
  }
  if (square > 0) scaling.inverse_depth = 1 / std::sqrt(square);
  return scaling;
}

/// Rows of the homography without its last element, which is 1, and the parallax.
Vector unknowns_of(const ProjectorModel& model, const Scaling& scaling) {
  auto homography = scaling.projector * model.from_camera * glm::inverse(scaling.camera);
  auto parallax = scaling.projector * model.parallax / scaling.inverse_depth;
  parallax /= homography[2][2];
  homography /= homography[2][2];
  Vector unknowns;
  for (int i = 0; i < 8; ++i) unknowns[i] = homography[i % 3][i / 3];
  for (int i = 0; i < 3; ++i) unknowns[8 + i] = parallax[i];
  return unknowns;
}

ProjectorModel model_of(const Vector& unknowns, const Scaling& scaling, double plane_m) {
  glm::dmat3 homography(1);
  for (int i = 0; i < 8; ++i) homography[i % 3][i / 3] = unknowns[i];
  const glm::dvec3 parallax(unknowns[8], unknowns[9], unknowns[10]);
  const auto back = glm::inverse(scaling.projector);
  return ProjectorModel{back * homography * scaling.camera, back * parallax * scaling.inverse_depth,
                        plane_m}
      .normalised();
}

/// The residual of an observation in standard deviations, and its derivatives.
struct Linearised {
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 11> slope;
};

/// `observation` in px; the unknowns are scaled.
Linearised linearised(const Vector& u, const Scaling& scaling, double plane_m,
                      const Observation& observation) {
  const auto from = scaling.camera * glm::dvec3(observation.camera_px, 1);
  const auto to = scaling.projector * glm::dvec3(observation.projector_px, 1);
  const double lift = (observation.inverse_depth - 1 / plane_m) * scaling.inverse_depth;
  const double depth = u[6] * from.x + u[7] * from.y + 1 + u[10] * lift;
  const Eigen::Vector2d at((u[0] * from.x + u[1] * from.y + u[2] + u[8] * lift) / depth,
                           (u[3] * from.x + u[4] * from.y + u[5] + u[9] * lift) / depth);
  const double weight = 1 / (observation.sigma_px * scaling.projector[0][0]);
  Linearised out;
  out.residual = weight * (Eigen::Vector2d(to.x, to.y) - at);
  const double gain = weight / depth;
  for (int axis = 0; axis < 2; ++axis) {
    out.slope.row(axis).setZero();
    out.slope.block<1, 3>(axis, 3 * axis) << gain * from.x, gain * from.y, gain;
    out.slope(axis, 6) = -gain * at[axis] * from.x;
    out.slope(axis, 7) = -gain * at[axis] * from.y;
    out.slope(axis, 8 + axis) = gain * lift;
    out.slope(axis, 10) = -gain * at[axis] * lift;
  }
  return out;
}

double cost_of(const Vector& unknowns, const Scaling& scaling, double plane_m,
               std::span<const Observation> observations) {
  double cost = 0;
  for (const auto& observation : observations)
    cost += linearised(unknowns, scaling, plane_m, observation).residual.squaredNorm();
  return cost;
}

void add(Eigen::Ref<Normal> normal, Eigen::Ref<Vector> right, const Linearised& line) {
  normal.noalias() += line.slope.transpose() * line.slope;
  right.noalias() += line.slope.transpose() * line.residual;
}

/// The step that solves the equations of the first `count` unknowns; nothing if they are singular.
std::optional<Vector> solved(const Normal& normal, const Vector& right, int count) {
  const Eigen::MatrixXd part = normal.topLeftCorner(count, count);
  // With a diagonal of 1, what remains of it in the elimination tells how far the equations are
  // from singular.
  const Eigen::VectorXd scale = part.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factors(scale.asDiagonal() * part * scale.asDiagonal());
  if (factors.info() != Eigen::Success) return {};
  const Eigen::MatrixXd lower = factors.matrixL();
  const double least = lower.diagonal().minCoeff();
  if (!(least * least > kSingular)) return {};
  Vector step = Vector::Zero();
  step.head(count) = scale.asDiagonal() * factors.solve(scale.asDiagonal() * right.head(count));
  return step;
}

ProjectorModel undetermined(double plane_m) {
  return {glm::dmat3(std::nan("")), glm::dvec3(std::nan("")), plane_m};
}

}  // namespace

double residual_px(const ProjectorModel& model, const Observation& observation) {
  return glm::distance(model.pixel_of(observation.camera_px, 1 / observation.inverse_depth),
                       observation.projector_px);
}

ProjectorModel refined(const ProjectorModel& start, std::span<const Observation> observations,
                       Unknowns unknowns) {
  const int count = static_cast<int>(unknowns);
  const auto scaling = scaling_of(observations, start.plane_m);
  Vector best = unknowns_of(start, scaling);
  if (unknowns == Unknowns::homography) best.tail<3>().setZero();
  double cost = cost_of(best, scaling, start.plane_m, observations);
  double damping = kFirstDamping;
  for (int step = 0; step < kMostSteps; ++step) {
    Normal normal = Normal::Zero();
    Vector right = Vector::Zero();
    for (const auto& observation : observations)
      add(normal, right, linearised(best, scaling, start.plane_m, observation));
    if (!solved(normal, right, count)) return undetermined(start.plane_m);
    const double before = cost;
    while (damping < kMostDamping) {
      Normal damped = normal;
      damped.diagonal() *= 1 + damping;
      const auto move = solved(damped, right, count);
      const Vector next = best + move.value_or(Vector::Zero());
      const double next_cost = cost_of(next, scaling, start.plane_m, observations);
      if (move && next_cost <= cost) {
        best = next;
        cost = next_cost;
        damping = std::max(damping / 10, 1e-12);
        break;
      }
      damping *= 10;
    }
    if (damping >= kMostDamping || before - cost <= kDone * before) break;
  }
  return model_of(best, scaling, start.plane_m);
}

Replicas::Replicas(const ProjectorModel& best, std::span<const Observation> observations,
                   Unknowns unknowns, int blocks)
    : best_(best),
      unknowns_(unknowns),
      scaling_(scaling_of(observations, best.plane_m)),
      blocks_(static_cast<std::size_t>(blocks)) {
  const Vector at = unknowns_of(best, scaling_);
  for (const auto& observation : observations) {
    auto& sums = blocks_[static_cast<std::size_t>(observation.block)];
    add(Eigen::Map<Normal>(sums.normal.data()), Eigen::Map<Vector>(sums.right.data()),
        linearised(at, scaling_, best.plane_m, observation));
  }
}

std::optional<ProjectorModel> Replicas::with_weights(std::span<const double> weights) const {
  Normal normal = Normal::Zero();
  Vector right = Vector::Zero();
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (weights[i] == 0) continue;
    normal += weights[i] * Eigen::Map<const Normal>(blocks_[i].normal.data());
    right += weights[i] * Eigen::Map<const Vector>(blocks_[i].right.data());
  }
  const auto step = solved(normal, right, static_cast<int>(unknowns_));
  if (!step) return {};
  return model_of(unknowns_of(best_, scaling_) + *step, scaling_, best_.plane_m);
}

}  // namespace handcast::calib
