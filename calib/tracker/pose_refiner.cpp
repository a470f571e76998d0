// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/pose_refiner.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace handcast::calib {
namespace {

constexpr double kNearest_m = 0.05;
constexpr double kTukeyLimit = 4.685;  ///< 95 % efficiency on normal errors

double distance_px(const Difference& difference) { return glm::length(difference.error_px); }

}  // namespace

PoseAndOffset stepped(const PoseAndOffset& from, const Vector7& step, const glm::dvec3& centre_m) {
  const glm::dvec3 turn(step[0], step[1], step[2]), shift(step[3], step[4], step[5]);
  const double angle = glm::length(turn);
  const glm::dmat4 rotation =
      angle > 0 ? glm::rotate(glm::dmat4(1), angle, turn / angle) : glm::dmat4(1);
  return {glm::translate(glm::dmat4(1), centre_m + shift) * rotation *
              glm::translate(glm::dmat4(1), -centre_m) * from.camera_from_tracker,
          from.offset_s + step[6]};
}

std::optional<Difference> difference(const Sighting& seen, const TrackerPath& path,
                                     const CameraModel& camera, const PoseAndOffset& at,
                                     const glm::dvec3& centre_m) {
  const auto moving =
      path.at(seen.time_ns + static_cast<std::int64_t>(at.offset_s * 1e9), seen.point);
  if (!moving) return std::nullopt;
  const glm::dvec3 p(at.camera_from_tracker * glm::dvec4(moving->place_m, 1));
  if (!(p.z > kNearest_m)) return std::nullopt;
  const glm::dvec3 velocity(at.camera_from_tracker * glm::dvec4(moving->velocity_m_s, 0));
  const double fx = camera.fx_px / p.z, fy = camera.fy_px / p.z;
  Eigen::Matrix<double, 2, 3> projection;
  projection << fx, 0, -fx * p.x / p.z, 0, fy, -fy * p.y / p.z;
  const glm::dvec3 arm = p - centre_m;
  Eigen::Matrix<double, 3, 7> moves;  // of p: turn x arm, shift, velocity
  moves << 0, arm.z, -arm.y, 1, 0, 0, velocity.x,  //
      -arm.z, 0, arm.x, 0, 1, 0, velocity.y,       //
      arm.y, -arm.x, 0, 0, 0, 1, velocity.z;
  return Difference{seen.undistorted_px - camera.project(p), projection * moves, seen.sigma_px};
}

Vector7 NormalEquations::step() const {
  const Eigen::LDLT<Matrix7> factors(matrix);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return Vector7::Zero();
  const Vector7 step = factors.solve(right);
  return step.allFinite() ? step : Vector7::Zero();
}

double robust_sigma_px(std::vector<double> distances_px) {
  if (distances_px.empty()) return 0;
  const auto middle = distances_px.begin() + static_cast<std::ptrdiff_t>(distances_px.size() / 2);
  std::nth_element(distances_px.begin(), middle, distances_px.end());
  return *middle / std::sqrt(2 * std::log(2.0));
}

PoseAndOffset refine(std::span<const Sighting> seen, const TrackerPath& path,
                     const CameraModel& camera, PoseAndOffset start, const glm::dvec3& centre_m) {
  constexpr int kIterations = 30;
  constexpr double kLeastSigma_px = 0.2, kDone = 1e-8;
  for (int i = 0; i < kIterations; ++i) {
    std::vector<Difference> differences;
    std::vector<double> distances;
    for (const auto& one : seen)
      if (const auto found = difference(one, path, camera, start, centre_m)) {
        differences.push_back(*found);
        distances.push_back(distance_px(*found));
      }
    const double limit = kTukeyLimit * std::max(kLeastSigma_px, robust_sigma_px(distances));
    NormalEquations equations;
    for (const auto& one : differences)
      if (const double weight = tukey(distance_px(one), limit); weight > 0)
        equations.add(one, weight);
    const Vector7 step = equations.step();
    start = stepped(start, step, centre_m);
    if (step.norm() < kDone) break;
  }
  return start;
}

}  // namespace handcast::calib
