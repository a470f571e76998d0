// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/lens_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "calib/solve/lens/coverage.hpp"
#include "calib/solve/lens/select.hpp"
#include "calib/solve/lens/solve.hpp"
#include "calib/solve/lens/spread.hpp"

namespace handcast::calib {
namespace {

/// The fit of one model of distortion, and how well each model predicts views not seen.
struct Choice {
  Distortion distortion = Distortion::none;
  Solution solution;
  std::array<double, 5> held_out_px{};  ///< root mean square; infinite if there is no fit
};

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

/// Fits each model and takes the simplest that is as good as the best one. Each view is predicted
/// by a fit of the other views, without one part of five: its board's pose is its own, the lens is
/// not. `start`: nearly right. Nothing if no model has a fit.
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

/// The share of the cells of Coverage that must have had a corner.
constexpr double kLeastArea = 0.4;
constexpr double kLeastTilt_rad = 5 * std::numbers::pi / 180;
/// Largest standard deviation of a focal length, as a share of it.
constexpr double kFocalUncertain = 0.02;

Result<void> check_area(const Selection& selection, std::span<const BoardView> views, int width_px,
                        int height_px) {
  Coverage coverage(width_px, height_px);
  for (const auto place : selection.places) coverage.add(views[place]);
  if (coverage.area() >= kLeastArea) return {};
  return fail(Errc::bad_data,
              fmt::format("The board was in only {:.0f} % of the image, too little for the "
                          "distortion of the lens; hold it also at the edges and in the corners.",
                          coverage.area() * 100));
}

Result<void> check_tilts(const Solution& solution) {
  double largest_rad = 0;
  for (const auto& pose : solution.poses) {
    const double cosine = std::min(std::abs(matrix_of(pose)[2].z), 1.);
    largest_rad = std::max(largest_rad, std::acos(cosine));
  }
  if (largest_rad >= kLeastTilt_rad) return {};
  return not_tilted("since the board was parallel to the image in all views");
}

/// Where the fit has each board, those of rejected views as well.
void describe_views(std::span<const BoardView> views, Selection& selection, LensFit& fit) {
  double squares = 0, corners = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    FittedView view;
    view.rejected = std::move(selection.reasons[i]);
    if (const auto placed = place(points_of(views[i]), fit.camera)) {
      view.rms_px = placed->rms_px;
      view.camera_from_board = matrix_of(placed->pose);
    }
    if (view.rejected.empty()) {
      const auto count = static_cast<double>(views[i].ids.size());
      squares += view.rms_px * view.rms_px * count;
      corners += count;
    }
    fit.views.push_back(std::move(view));
  }
  fit.rms_px = std::sqrt(squares / corners);
}

}  // namespace

Result<LensFit> fit_lens(std::span<const BoardView> views, int width_px, int height_px) {
  auto selection = select(views);
  if (selection.views.size() < kFewestViews) return too_few(selection.views.size());
  if (auto checked = check_area(selection, views, width_px, height_px); !checked)
    return tl::make_unexpected(checked.error());
  const auto first = solve_robustly(selection, width_px, height_px);
  if (!first) return tl::make_unexpected(first.error());
  if (auto checked = check_tilts(*first); !checked) return tl::make_unexpected(checked.error());
  const auto choice = choose(selection.views, *first);
  if (!choice) return not_tilted("since the views do not differ enough");

  LensFit fit;
  fit.camera = choice->solution.camera;
  fit.distortion = choice->distortion;
  fit.held_out_of_px = choice->held_out_px;
  fit.held_out_px = fit.held_out_of_px[static_cast<std::size_t>(fit.distortion)];
  const auto spread = spreads_of(selection.views, choice->solution, fit.distortion);
  fit.spreads = spread.spreads;
  fit.covariance = spread.covariance;
  const double uncertain = fit.spreads[0].deviation / fit.camera.fx_px;
  if (!(uncertain < kFocalUncertain))
    return not_tilted(fmt::format("it may be off by {:.0f} %", 200 * uncertain));
  describe_views(views, selection, fit);
  return fit;
}

}  // namespace handcast::calib
