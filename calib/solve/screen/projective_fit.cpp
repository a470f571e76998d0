// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/projective_fit.hpp"

#include <cmath>

#include "calib/least_squares/levenberg_marquardt.hpp"

namespace handcast::calib {
namespace {

using Vector = Eigen::Matrix<double, 11, 1>;
using Scaling = Replicas::Scaling;

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

void add(NormalEquations& equations, const Linearised& line) {
  equations.matrix.noalias() += line.slope.transpose() * line.slope;
  equations.slope.noalias() += line.slope.transpose() * line.residual;
  equations.cost += line.residual.squaredNorm();
}

Vector moved(Vector unknowns, const Eigen::VectorXd& step) {
  unknowns.head(step.size()) += step;
  return unknowns;
}

}  // namespace

double residual_px(const ProjectorModel& model, const Observation& observation) {
  return glm::distance(model.pixel_of(observation.camera_px, 1 / observation.inverse_depth),
                       observation.projector_px);
}

ProjectorModel refined(const ProjectorModel& start, std::span<const Observation> observations,
                       Unknowns unknowns) {
  constexpr Effort kEffort{.steps = 30, .done = 1e-10};
  const auto scaling = scaling_of(observations, start.plane_m);
  Vector best = unknowns_of(start, scaling);
  if (unknowns == Unknowns::homography) best.tail<3>().setZero();
  const auto equations_at = [&](const Vector& at) {
    auto equations = NormalEquations::zero(best.size());
    for (const auto& observation : observations)
      add(equations, linearised(at, scaling, start.plane_m, observation));
    return equations.of_first(static_cast<int>(unknowns));
  };
  if (!minimise(best, kEffort, equations_at, moved).step())
    return {glm::dmat3(std::nan("")), glm::dvec3(std::nan("")), start.plane_m};
  return model_of(best, scaling, start.plane_m);
}

Replicas::Replicas(const ProjectorModel& best, std::span<const Observation> observations,
                   Unknowns unknowns, int blocks)
    : best_(best),
      unknowns_(unknowns),
      scaling_(scaling_of(observations, best.plane_m)),
      blocks_(static_cast<std::size_t>(blocks), NormalEquations::zero(Vector::RowsAtCompileTime)) {
  const Vector at = unknowns_of(best, scaling_);
  for (const auto& observation : observations)
    add(blocks_[static_cast<std::size_t>(observation.block)],
        linearised(at, scaling_, best.plane_m, observation));
}

std::optional<ProjectorModel> Replicas::with_weights(std::span<const double> weights) const {
  auto sum = NormalEquations::zero(Vector::RowsAtCompileTime);
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    if (weights[i] > 0) sum.add(blocks_[i], weights[i]);
  const auto step = sum.of_first(static_cast<int>(unknowns_)).step();
  if (!step) return {};
  return model_of(moved(unknowns_of(best_, scaling_), *step), scaling_, best_.plane_m);
}

}  // namespace handcast::calib
