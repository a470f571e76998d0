// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/lens_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/solve/lens/choose.hpp"
#include "calib/solve/lens/coverage.hpp"
#include "calib/solve/lens/select.hpp"
#include "calib/solve/lens/solve.hpp"
#include "calib/solve/lens/spread.hpp"

namespace handcast::calib {
namespace {

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
