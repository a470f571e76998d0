// SPDX-License-Identifier: Apache-2.0
#include "calib/lens/lens_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/core.hpp>

#include "calib/lens/coverage.hpp"
#include "calib/lens/solve.hpp"
#include "calib/lens/spread.hpp"
#include "calib/lens/tilt.hpp"

namespace handcast::calib {
namespace {

constexpr std::size_t kFewestViews = 6, kFewestCorners = 6;
constexpr int kParts = 5;
/// A corner farther from where the board's homography has it is a mistake, in squares.
constexpr double kMistake = 0.5;
/// A view is left out if its error exceeds the median by so many robust standard deviations, and by
/// this factor: with few views the deviation itself is uncertain.
/// @{
constexpr double kOutlier = 3, kOutlierFactor = 1.5;
/// @}
/// Of the views, as many may contradict the others.
constexpr double kMostRejected = 0.3;
/// Of the cells of Coverage, so many must have had a corner.
constexpr double kLeastArea = 0.4;
constexpr double kLeastTilt_rad = 5 * std::numbers::pi / 180;
/// Largest standard deviation of a focal length, as a share of it.
constexpr double kFocalUncertain = 0.02;

/// The views that take part, their places in the caller's list, and why the others do not.
struct Selection {
  std::vector<Points> views;
  std::vector<std::size_t> places;
  std::vector<std::string> reasons;  ///< of all views; empty: takes part

  void reject(std::size_t i, std::string reason) {
    reasons[places[i]] = std::move(reason);
    views.erase(views.begin() + static_cast<std::ptrdiff_t>(i));
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(i));
  }
};

struct Size {
  int width_px, height_px;
};

bool is_finite(const BoardView& view) {
  return view.ids.size() == view.image_px.size() && view.ids.size() == view.board_m.size() &&
         std::ranges::all_of(view.image_px,
                             [](auto px) { return std::isfinite(px.x) && std::isfinite(px.y); }) &&
         std::ranges::all_of(view.board_m, [](auto m) { return std::isfinite(m.x + m.y + m.z); });
}

std::string fault_of(const BoardView& view) {
  if (!is_finite(view)) return "The view has corners that are not numbers.";
  if (view.ids.size() < kFewestCorners)
    return fmt::format("The view has {} corners; at least {} are needed.", view.ids.size(),
                       kFewestCorners);
  if (mistake_of(view) > kMistake)
    return "The corners do not lie on a flat board; some were mistaken for others.";
  return {};
}

Selection select(std::span<const BoardView> views) {
  Selection selection;
  for (std::size_t i = 0; i < views.size(); ++i) {
    selection.reasons.push_back(fault_of(views[i]));
    if (!selection.reasons.back().empty()) continue;
    selection.views.push_back(points_of(views[i]));
    selection.places.push_back(i);
  }
  return selection;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The largest error of a view that is no outlier.
double limit_px(const std::vector<double>& rms_px) {
  constexpr double kDeviations = 1.4826;  // of a normal distribution, in median absolute deviations
  const double middle_px = median(rms_px);
  std::vector<double> off_px;
  for (const double px : rms_px) off_px.push_back(std::abs(px - middle_px));
  return std::max(middle_px + kOutlier * kDeviations * median(off_px), kOutlierFactor * middle_px);
}

tl::unexpected<Error> too_few(std::size_t views) {
  return fail(Errc::bad_data,
              fmt::format("The lens cannot be determined from {} views of the board; take at least "
                          "{}, better 15, with the board in all parts of the image.",
                          views, kFewestViews));
}

tl::unexpected<Error> not_tilted(std::string_view why) {
  return fail(Errc::bad_data,
              fmt::format("The focal length cannot be determined, {}; tilt the board by 20 to 40 "
                          "degrees to the left, to the right, up and down.",
                          why));
}

/// Solves without the views that contradict the others, the worst one first. The model is the
/// richest: what it cannot explain is a mistake and no distortion.
Result<Solution> solve_robustly(Selection& selection, Size size) {
  const auto before = selection.views.size();
  for (;;) {
    if (selection.views.size() < kFewestViews) return too_few(selection.views.size());
    const auto guess = first_guess(selection.views, size.width_px, size.height_px);
    const auto solution = guess ? solve(selection.views, Distortion::k3, *guess) : std::nullopt;
    if (!solution) return not_tilted("since the views do not differ enough");
    const double limit = limit_px(solution->rms_px);
    const auto worst = std::ranges::max_element(solution->rms_px);
    if (*worst <= limit) return *solution;
    const auto rejected = before - selection.views.size() + 1;
    if (static_cast<double>(rejected) > kMostRejected * static_cast<double>(before))
      return fail(Errc::bad_data,
                  "The views contradict each other; keep the board flat and still, and check the "
                  "size of its squares.");
    selection.reject(static_cast<std::size_t>(worst - solution->rms_px.begin()),
                     fmt::format("Its error of {:.2f} px is far above the {:.2f} px of the usual "
                                 "view.",
                                 *worst, median(solution->rms_px)));
  }
}

Result<void> check_area(const Selection& selection, std::span<const BoardView> views, Size size) {
  Coverage coverage(size.width_px, size.height_px);
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

/// The squared errors of the views, each predicted by a fit of those of the other parts; empty if
/// a part has no fit.
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

/// Fits each model and takes the simplest that is as good as the best.
std::optional<Solution> choose(std::span<const Points> views, const Solution& start,
                               LensFit& fit) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::array<std::optional<Solution>, 5> solutions;
  std::array<std::vector<double>, 5> squares;
  std::array<double, 5> means;
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    solutions[i] = solve(views, static_cast<Distortion>(i), start);
    if (solutions[i]) squares[i] = held_out(views, static_cast<Distortion>(i), *solutions[i]);
    means[i] = squares[i].empty() ? kNone : mean(squares[i]);
    fit.held_out_of_px[i] = std::sqrt(means[i]);
  }
  const auto best = static_cast<std::size_t>(std::ranges::min_element(means) - means.begin());
  std::size_t chosen = 0;
  while (chosen < best && (squares[chosen].empty() || !as_good(squares[chosen], squares[best])))
    ++chosen;
  fit.distortion = static_cast<Distortion>(chosen);
  fit.held_out_px = fit.held_out_of_px[chosen];
  return solutions[chosen];
}

/// Where the fit has each board, those of rejected views as well.
void describe_views(std::span<const BoardView> views, Selection& selection, LensFit& fit) {
  double squares = 0, corners = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    FittedView view;
    view.rejected = std::move(selection.reasons[i]);
    if (const auto placed =
            is_finite(views[i]) ? place(points_of(views[i]), fit.camera) : std::nullopt) {
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
  const Size size{width_px, height_px};
  auto selection = select(views);
  if (selection.views.size() < kFewestViews) return too_few(selection.views.size());
  if (auto checked = check_area(selection, views, size); !checked)
    return tl::make_unexpected(checked.error());
  const auto first = solve_robustly(selection, size);
  if (!first) return tl::make_unexpected(first.error());
  if (auto checked = check_tilts(*first); !checked) return tl::make_unexpected(checked.error());

  LensFit fit;
  const auto solution = choose(selection.views, *first, fit);
  if (!solution) return not_tilted("since the views do not differ enough");
  fit.camera = solution->camera;
  fit.spreads = spreads_of(selection.views, *solution, fit.distortion);
  const double uncertain = fit.spreads[0].deviation / fit.camera.fx_px;
  if (!(uncertain < kFocalUncertain))
    return not_tilted(fmt::format("it may be off by {:.0f} %", 200 * uncertain));
  describe_views(views, selection, fit);
  return fit;
}

}  // namespace handcast::calib
