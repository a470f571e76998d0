// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/pair/pair_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "calib/solve/lens/select.hpp"
#include "calib/solve/lens/spread.hpp"
#include "calib/solve/pair/corner_error.hpp"
#include "calib/solve/pair/pair_solve.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

using LensMatrix = Eigen::Matrix<double, kLensNumbers, kLensNumbers>;

/// A matrix that makes errors of this covariance of independent ones.
LensMatrix root_of(const LensCovariance& covariance) {
  LensMatrix matrix;
  for (int i = 0; i < kLensNumbers; ++i)
    for (int j = 0; j < kLensNumbers; ++j)
      matrix(i, j) = covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const Eigen::SelfAdjointEigenSolver<LensMatrix> solver(matrix);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

/// By how much the lenses may be off; the pose of the second camera has 0.
Eigen::VectorXd lens_errors(const std::array<LensMatrix, 2>& roots, std::mt19937& random) {
  std::normal_distribution<double> normal(0, 1);
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(kShared);
  int at = kPoseNumbers;
  for (const auto& root : roots) {
    const Eigen::Matrix<double, kLensNumbers, 1> drawn =
        Eigen::Matrix<double, kLensNumbers, 1>::NullaryExpr([&] { return normal(random); });
    errors.segment<kLensNumbers>(at) = root * drawn;
    at += kLensNumbers;
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

/// Poses of the second camera as other views and other lenses would have given them: the bootstrap
/// of lens/spread.hpp, which also draws the error of each lens by its covariance. A fit with
/// measured lenses is off by their errors, too, which are the same in all views: the views alone do
/// not show them.
std::vector<Pose> resample(std::span<const PairPoints> views, const KnownLenses& lenses,
                           const PairSolution& solution) {
  const Cameras cameras{lenses[0].camera, lenses[1].camera};
  std::vector<NormalEquations> of_cameras;
  for (std::size_t i = 0; i < views.size(); ++i)
    of_cameras.push_back(normal_of(views[i], solution.boards[i], solution.pair, cameras, kShared)
                             .without_first(kPoseNumbers));
  const std::array roots{root_of(lenses[0].covariance), root_of(lenses[1].covariance)};
  std::vector<Pose> poses;
  for (const auto& step : bootstrap(of_cameras, [&](NormalEquations&sum, std::mt19937&random) {
         sum.slope -= sum.matrix.selfadjointView<Eigen::Lower>() * lens_errors(roots, random);
         sum = sum.of_first(kPoseNumbers);
       })) {
    poses.push_back(solution.pair);
    move(poses.back(), step);
  }
  return poses;
}

/// The spreads of a fit by these poses; sets apart_mm, place_mm, turn_deg and middle_mm. `views`:
/// how many there are. The intervals are those of Student's t; tests/bench/calib_pair.cpp measures
/// how often they hold the truth.
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
  constexpr double kShare = 0.95, kNormal = 1.96;
  fit.middle_mm = quantile(std::move(off_mm), kShare) * t / kNormal;
}

constexpr double kMostRejected = 0.3;  ///< the share of the views that may contradict the others
constexpr double kHarmless_px = 0.25;  ///< so little is no contradiction
constexpr double kNonsense_px = 5;     ///< no still board is so far from where it is expected

/// The views that take part, their places in the caller's list, and why the others do not.
struct Chosen {
  std::vector<PairPoints> views;
  std::vector<std::size_t> places;
  std::vector<std::string> reasons;  ///< of all views; empty: takes part
};

Chosen choose(std::span<const PairView> views) {
  Chosen chosen;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto first = select(std::array{views[i].first}),
               second = select(std::array{views[i].second});
    std::string reason;
    if (first.views.empty())
      reason = "In the first image: " + first.reasons.front();
    else if (second.views.empty())
      reason = "In the second image: " + second.reasons.front();
    if (reason.empty()) {
      chosen.views.push_back({first.views.front(), second.views.front()});
      chosen.places.push_back(i);
    }
    chosen.reasons.push_back(std::move(reason));
  }
  return chosen;
}

void reject(Chosen& chosen, std::size_t i, std::string reason) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  chosen.reasons[chosen.places[i]] = std::move(reason);
  chosen.views.erase(chosen.views.begin() + at);
  chosen.places.erase(chosen.places.begin() + at);
}

Result<void> check_enough(const Chosen& chosen) {
  if (chosen.views.size() >= kFewestViews) return {};
  return fail(Errc::bad_data,
              fmt::format("The second camera's place cannot be determined from {} views of the "
                          "board; hold it still where both cameras see it, at least at {} places, "
                          "better 15.",
                          chosen.views.size(), kFewestViews));
}

/// Solves without the views that contradict the others. The worst view goes first: it may be what
/// makes the others look bad.
Result<PairSolution> solve_robustly(Chosen& chosen, const Cameras& cameras) {
  const auto before = chosen.views.size();
  for (;;) {
    if (auto enough = check_enough(chosen); !enough) return tl::make_unexpected(enough.error());
    const auto guess = first_guess(chosen.views, cameras);
    const auto solution = guess ? solve(chosen.views, cameras, *guess) : std::nullopt;
    if (!solution)
      return fail(Errc::bad_data, "The views do not determine the second camera's place.");
    const double limit = limit_px(solution->rms_px);
    const auto worst = std::ranges::max_element(solution->rms_px);
    if (*worst <= std::clamp(limit, kHarmless_px, kNonsense_px)) return *solution;
    const auto rejected = before - chosen.views.size() + 1;
    if (static_cast<double>(rejected) > kMostRejected * static_cast<double>(before))
      return fail(Errc::bad_data,
                  "The views contradict each other: did a camera move, is one lens that of the "
                  "other camera, or was the board not still?");
    reject(
        chosen, static_cast<std::size_t>(worst - solution->rms_px.begin()),
        fmt::format("Its error of {:.2f} px is far above the usual one; the board was not still, "
                    "or its images are of different times.",
                    *worst));
  }
}

glm::dvec3 middle_of_m(const Chosen& chosen, const PairSolution& solution) {
  glm::dvec3 sum_m(0);
  double corners = 0;
  for (std::size_t i = 0; i < chosen.views.size(); ++i) {
    const auto first_from_board = matrix_of(solution.boards[i]);
    for (const auto& m : chosen.views[i].first.board_m) {
      sum_m += glm::dvec3(first_from_board * glm::dvec4(m.x, m.y, m.z, 1));
      ++corners;
    }
  }
  return sum_m / corners;
}

/// Sets views and rms_px.
void describe_views(const Chosen& chosen, const PairSolution& solution, PairFit& fit) {
  for (const auto& reason : chosen.reasons) fit.views.push_back({0, reason});
  double squares = 0, corners = 0;
  for (std::size_t i = 0; i < chosen.views.size(); ++i) {
    const auto& [first, second] = chosen.views[i];
    const auto count = static_cast<double>(first.image_px.size() + second.image_px.size());
    fit.views[chosen.places[i]].rms_px = solution.rms_px[i];
    squares += solution.rms_px[i] * solution.rms_px[i] * count;
    corners += count;
  }
  fit.rms_px = std::sqrt(squares / corners);
}

}  // namespace

Result<PairFit> fit_pair(std::span<const PairView> views, const KnownLenses& lenses) {
  const Cameras cameras{lenses[0].camera, lenses[1].camera};
  auto chosen = choose(views);
  const auto solution = solve_robustly(chosen, cameras);
  if (!solution) return tl::make_unexpected(solution.error());
  const auto error = held_out(chosen.views, cameras, *solution);
  if (!error)
    return fail(Errc::bad_data,
                "The cameras never saw the same corners of the board; hold it where both see all "
                "of it.");
  const auto poses = resample(chosen.views, lenses, *solution);
  if (poses.empty())
    return fail(Errc::bad_data, "The views do not determine the second camera's place.");
  PairFit fit;
  fit.second_from_first = matrix_of(solution->pair);
  fit.held_out_px = error->epipolar_px;
  fit.held_out_mm = error->place_mm;
  fit.middle_m = middle_of_m(chosen, *solution);
  describe_views(chosen, *solution, fit);
  describe_spread(poses, chosen.views.size(), fit);
  return fit;
}

}  // namespace handcast::calib
