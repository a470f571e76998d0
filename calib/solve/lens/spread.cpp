// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/spread.hpp"

#include <cmath>

#include "calib/solve/lens/normal.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {

std::vector<Eigen::VectorXd> bootstrap(
    std::span<const NormalEquations> views,
    const std::function<void(NormalEquations& sum, std::mt19937& random)>& change) {
  constexpr int kResamples = 1000;
  std::mt19937 random(1);
  std::vector<Eigen::VectorXd> steps;
  for (int i = 0; i < kResamples; ++i) {
    auto sum = NormalEquations::zero(views.front().slope.size());
    for (std::size_t draw = 0; draw < views.size(); ++draw) sum.add(views[random() % views.size()]);
    if (change) change(sum, random);
    if (const auto step = sum.step()) steps.push_back(*step);
  }
  return steps;
}

Spreads spreads_of(std::span<const Points> views, const Solution& solution, Distortion distortion) {
  std::vector<NormalEquations> of_camera;
  for (std::size_t i = 0; i < views.size(); ++i)
    of_camera.push_back(normal_of(views[i], solution.poses[i], solution.camera, distortion)
                            .without_first(kPoseNumbers));
  const int count = free_parameters(distortion);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  const auto steps = bootstrap(of_camera);
  for (const auto& step : steps) covariance += step * step.transpose();
  covariance /= static_cast<double>(steps.size());
  const double t = students_t(static_cast<double>(views.size()) - 1);
  Spreads found;
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    for (int j = 0; j < count; ++j)
      found.covariance[at][static_cast<std::size_t>(j)] = covariance(i, j);
    const double value = solution.camera.*kLensFields[at], deviation = std::sqrt(covariance(i, i));
    found.spreads[at] = {deviation, value - t * deviation, value + t * deviation};
  }
  return found;
}

}  // namespace handcast::calib
