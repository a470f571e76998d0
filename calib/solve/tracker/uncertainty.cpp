// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "ipc/base/clock.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr double kBin_s = kWander_s;
/// A block lasts as long as the errors stay correlated, but a recording needs a few of them.
constexpr double kBlock_s = 2.5;
constexpr std::size_t kLeastBlocks = 8;
constexpr int kResamples = 500;

NormalEquations sum_of(const std::vector<NormalEquations>& normals) {
  auto sum = NormalEquations::zero(7);
  for (const auto& n : normals) sum.add(n);
  return sum;
}

Change newton_step(const NormalEquations& normal) { return normal.step().value_or(Change::Zero()); }

std::size_t block_length(std::size_t bins) {
  const auto longest = static_cast<std::size_t>(kBlock_s / kBin_s);
  return std::clamp<std::size_t>(bins / kLeastBlocks, 1, longest);
}

/// The curvature is that of all blocks: resampled curvatures widen the intervals of 15 s by 15 %,
/// which then hold the truth too often.
Curvature bootstrap(const std::vector<NormalEquations>& normals) {
  const std::size_t bins = normals.size(), length = block_length(bins);
  const std::size_t blocks = bins / length;
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, bins - 1);
  const auto all = sum_of(normals);
  Curvature covariance = Curvature::Zero();
  for (int i = 0; i < kResamples; ++i) {
    NormalEquations sum{all.matrix, Change::Zero()};
    for (std::size_t b = 0; b < blocks; ++b) {
      const auto first = any(random);
      for (std::size_t k = 0; k < length; ++k) sum.slope += normals[(first + k) % bins].slope;
    }
    const auto change = newton_step(sum);
    covariance += change * change.transpose() / kResamples;
  }
  // As many blocks vary less about their own mean than about the true one.
  return covariance * static_cast<double>(blocks) / static_cast<double>(blocks - 1);
}

}  // namespace

Interval Uncertainty::spread(int unknown, double factor) const {
  const double sd = factor * std::sqrt(covariance(unknown, unknown));
  return {sd, -width * sd, width * sd};
}

PlaceError Uncertainty::place_error(const glm::dvec3& place_m) const {
  Eigen::Matrix<double, 3, 6> motion;
  motion << 0, place_m.z, -place_m.y, 1, 0, 0,  //
      -place_m.z, 0, place_m.x, 0, 1, 0,        //
      place_m.y, -place_m.x, 0, 0, 0, 1;
  const Eigen::Matrix3d error = motion * covariance.topLeftCorner<6, 6>() * motion.transpose();
  const auto ray = glm::normalize(place_m);
  const Eigen::Vector3d along(ray.x, ray.y, ray.z);
  const double whole = error.trace(), on_ray = along.dot(error * along);
  return {place_m, 1000 * std::sqrt(std::max(whole - on_ray, 0.)),
          1000 * std::sqrt(std::max(whole, 0.))};
}

Uncertainty uncertainty_of(const Observations& o, const Refined& refined) {
  const auto normals = normals_by_time(o, refined, kBin_s);
  Uncertainty uncertainty;
  uncertainty.covariance = bootstrap(normals);
  // What the blocks do not see: the tracker's common error outlasts them, and its mean over a short
  // recording is a shift of the pose.
  uncertainty.covariance.diagonal().segment<3>(3).array() +=
      variance_of_mean(common_errors(o, refined), kWander_s,
                       kBin_s * static_cast<double>(block_length(normals.size())));
  const std::size_t blocks = normals.size() / block_length(normals.size());
  uncertainty.width = students_t(static_cast<double>(blocks) - 1);
  for (const double factor : {0.5, 2.})
    if (const auto other = with_limit(o, refined, factor)) {
      const auto change = change_between(refined.pose, *other);
      uncertainty.covariance += change * change.transpose() / 2;
      uncertainty.limit_shift_mm =
          std::max(uncertainty.limit_shift_mm, 1000 * change.segment<3>(3).norm());
    }
  return uncertainty;
}

Residuals held_out(const Observations& o, const Refined& refined) {
  constexpr std::size_t kFolds = 5;
  const double begin_s = o.sightings.front().time_s;
  const double fold_s = (o.sightings.back().time_s - begin_s) / kFolds * (1 + 1e-9);
  const auto normals = normals_by_time(o, refined, fold_s);
  const auto all = sum_of(normals);
  std::vector<double> held_px;
  for (std::size_t f = 0; f < normals.size(); ++f) {
    auto rest = all;
    rest.add(normals[f], -1);
    const auto distances = o.distances_px(moved(refined.pose, newton_step(rest)));
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const auto& s = o.sightings[i];
      if (static_cast<std::size_t>((s.time_s - begin_s) / fold_s) == f &&
          distances[i] < kTukey * refined.scale * s.sigma)
        held_px.push_back(distances[i]);
    }
  }
  return {median(held_px), quantile(held_px, 0.95)};
}

}  // namespace handcast::calib
