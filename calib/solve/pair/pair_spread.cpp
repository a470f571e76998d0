// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/pair/pair_spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "calib/solve/lens/spread.hpp"

namespace handcast::calib {
namespace {

constexpr int kLens = 9;
using LensRoot = cv::Matx<double, kLens, kLens>;

/// A matrix that makes errors of this covariance of independent ones.
LensRoot root_of(const LensCovariance& covariance) {
  LensRoot matrix, directions;
  for (int i = 0; i < kLens; ++i)
    for (int j = 0; j < kLens; ++j)
      matrix(i, j) = covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  cv::Vec<double, kLens> variances;
  cv::eigen(matrix, variances, directions);
  LensRoot root = directions.t();
  for (int i = 0; i < kLens; ++i)
    for (int j = 0; j < kLens; ++j) root(i, j) *= std::sqrt(std::max(variances[j], 0.));
  return root;
}

/// By how much the lenses may be off; the pose of the second camera has 0.
SharedVector lens_errors(const std::array<LensRoot, 2>& roots, std::mt19937& random) {
  std::normal_distribution<double> normal(0, 1);
  SharedVector errors;
  int at = kPairPose;
  for (const auto& root : roots) {
    cv::Vec<double, kLens> drawn;
    for (int i = 0; i < kLens; ++i) drawn[i] = normal(random);
    const cv::Vec<double, kLens> error(root * drawn);
    for (int i = 0; i < kLens; ++i) errors[at++] = error[i];
  }
  return errors;
}

/// Mean square of what a function makes of each pose.
template <class Function>
double mean_square(const std::vector<Pose>& poses, const Function& function) {
  double sum = 0;
  for (const auto& pose : poses) {
    const double value = function(pose);
    sum += value * value;
  }
  return sum / static_cast<double>(poses.size());
}

/// In the axes of the first camera.
glm::dvec3 place_of_m(const Pose& pair) { return glm::dvec3(glm::inverse(matrix_of(pair))[3]); }

}  // namespace

std::vector<Pose> resample(std::span<const PairPoints> views, const KnownLenses& lenses,
                           const PairSolution& solution) {
  const Cameras cameras{lenses[0].camera, lenses[1].camera};
  std::vector<PairStatement> statements;
  for (std::size_t i = 0; i < views.size(); ++i)
    statements.push_back(
        statement_of(normal_of(views[i], solution.boards[i], solution.pair, cameras)));
  const std::array roots{root_of(lenses[0].covariance), root_of(lenses[1].covariance)};
  std::mt19937 random(1);
  std::vector<Pose> poses;
  for (int i = 0; i < kResamples; ++i) {
    PairStatement sum{};
    for (std::size_t draw = 0; draw < statements.size(); ++draw) {
      const auto& drawn = statements[random() % statements.size()];
      sum.matrix += drawn.matrix;
      sum.slope += drawn.slope;
    }
    const SharedVector slope = sum.slope - SharedVector(sum.matrix * lens_errors(roots, random));
    bool determined = false;
    const cv::Matx66d inverse =
        sum.matrix.get_minor<kPairPose, kPairPose>(0, 0).inv(cv::DECOMP_CHOLESKY, &determined);
    if (!determined) continue;
    const cv::Vec6d step = inverse * pair_part(slope);
    auto pose = solution.pair;
    pose.turn += cv::Vec3d(step[0], step[1], step[2]);
    pose.move += cv::Vec3d(step[3], step[4], step[5]);
    poses.push_back(pose);
  }
  return poses;
}

void describe_spread(const std::vector<Pose>& poses, std::size_t views, PairFit& fit) {
  constexpr double kM_to_mm = 1e3;
  const double t = students_t(static_cast<double>(views) - 1);
  const auto spread_of = [&](double value, const auto& value_of) {
    const double deviation =
        std::sqrt(mean_square(poses, [&](const Pose& pose) { return value_of(pose) - value; }));
    return Spread{deviation, value - t * deviation, value + t * deviation};
  };
  const auto place_m = glm::dvec3(glm::inverse(fit.second_from_first)[3]);
  fit.apart_mm = spread_of(kM_to_mm * glm::length(place_m),
                           [](const Pose& pose) { return kM_to_mm * cv::norm(pose.move); });
  const auto turn = pose_of(fit.second_from_first).turn;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    fit.place_mm[i] = spread_of(kM_to_mm * place_m[axis], [axis](const Pose& pose) {
      return kM_to_mm * place_of_m(pose)[axis];
    });
    fit.turn_deg[i] = spread_of(glm::degrees(turn[axis]),
                                [axis](const Pose& pose) { return glm::degrees(pose.turn[axis]); });
  }
  const glm::dvec4 middle(fit.middle_m, 1);
  const auto there = fit.second_from_first * middle;
  std::vector<double> off_mm;
  for (const auto& pose : poses)
    off_mm.push_back(kM_to_mm * glm::distance(matrix_of(pose) * middle, there));
  std::ranges::sort(off_mm);
  constexpr double kShare = 0.95, kNormal = 1.96;
  fit.middle_mm =
      off_mm[static_cast<std::size_t>(kShare * static_cast<double>(off_mm.size() - 1))] * t /
      kNormal;
}

}  // namespace handcast::calib
