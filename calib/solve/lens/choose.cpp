// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/choose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace handcast::calib {
namespace {

constexpr int kParts = 5;

/// The mean squared errors of the views, each predicted by a fit of the other parts; empty if a
/// part has no fit.
std::vector<double> held_out(std::span<const Points> views, Distortion distortion,
                             const Solution& start) {
  std::vector<double> squares(views.size());
  for (int part = 0; part < kParts; ++part) {
    std::vector<Points> others;
    Solution near{start.camera, {}, {}};
    for (std::size_t i = 0; i < views.size(); ++i)
      if (static_cast<int>(i) % kParts != part) {
        others.push_back(views[i]);
        near.poses.push_back(start.poses[i]);
        near.rms_px.push_back(start.rms_px[i]);
      }
    const auto fit = solve(others, distortion, near);
    if (!fit) return {};
    for (auto i = static_cast<std::size_t>(part); i < views.size(); i += kParts) {
      const auto placed = place(views[i], fit->camera);
      if (!placed) return {};
      squares[i] = placed->rms_px * placed->rms_px;
    }
  }
  return squares;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
}

/// True if the first errors are not larger than the second ones, by more than the standard error
/// of the mean of their differences.
bool as_good(const std::vector<double>& squares, const std::vector<double>& best) {
  std::vector<double> more;
  for (std::size_t i = 0; i < best.size(); ++i) more.push_back(squares[i] - best[i]);
  const double middle = mean(more);
  double variance = 0;
  for (const double value : more) variance += (value - middle) * (value - middle);
  const auto count = static_cast<double>(more.size());
  return middle <= std::sqrt(variance / (count * (count - 1)));
}

/// Over all corners.
double rms_of(const std::vector<double>& squares, std::span<const Points> views) {
  double sum = 0, corners = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto count = static_cast<double>(views[i].image_px.size());
    sum += squares[i] * count;
    corners += count;
  }
  return std::sqrt(sum / corners);
}

}  // namespace

std::optional<Choice> choose(std::span<const Points> views, const Solution& start) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::array<std::optional<Solution>, 5> solutions;
  std::array<std::vector<double>, 5> squares;
  Choice choice;
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    solutions[i] = solve(views, static_cast<Distortion>(i), start);
    if (solutions[i]) squares[i] = held_out(views, static_cast<Distortion>(i), *solutions[i]);
    choice.held_out_px[i] = squares[i].empty() ? kNone : rms_of(squares[i], views);
  }
  const auto best = std::ranges::min_element(choice.held_out_px) - choice.held_out_px.begin();
  const auto& best_squares = squares[static_cast<std::size_t>(best)];
  if (best_squares.empty()) return {};
  std::size_t chosen = 0;
  while (squares[chosen].empty() || !as_good(squares[chosen], best_squares)) ++chosen;
  choice.distortion = static_cast<Distortion>(chosen);
  choice.solution = *std::move(solutions[chosen]);
  return choice;
}

}  // namespace handcast::calib
