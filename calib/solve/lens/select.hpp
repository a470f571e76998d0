// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/solve/lens/solve.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calib {

constexpr std::size_t kFewestViews = 6;

/// The views that take part, their places in the caller's list, and why the others do not.
struct Selection {
  std::vector<Points> views;
  std::vector<std::size_t> places;
  std::vector<std::string> reasons;  ///< of all views; empty: takes part
};

/// Leaves out the views that cannot be of a flat board.
Selection select(std::span<const BoardView> views);

/// Solves without the views that contradict the others, and takes these from the selection. The
/// model is the richest: what it cannot explain is a mistake and no distortion. Errors: bad_data
/// (too few views are left, they contradict each other, or they do not determine a camera).
Result<Solution> solve_robustly(Selection& selection, int width_px, int height_px);

/// The largest error, px, of a view that does not contradict the others. `rms_px`: of all views.
double limit_px(const std::vector<double>& rms_px);

/// The sentences for views that do not determine a camera.
/// @{
tl::unexpected<Error> too_few(std::size_t views);
tl::unexpected<Error> not_tilted(std::string_view why);
/// @}

}  // namespace handcast::calib
