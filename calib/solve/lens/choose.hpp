// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "calib/solve/lens/solve.hpp"

namespace handcast::calib {

/// The fit of one model of distortion, and how well each model predicts views not seen.
struct Choice {
  Distortion distortion = Distortion::none;
  Solution solution;
  std::array<double, 5> held_out_px{};  ///< root mean square; infinite if there is no fit
};

/// Fits each model and takes the simplest that is as good as the best one. Each view is predicted
/// by a fit of the other views, without one part of five: its board's pose is its own, the lens is
/// not. `start`: nearly right. Nothing if no model has a fit.
std::optional<Choice> choose(std::span<const Points> views, const Solution& start);

}  // namespace handcast::calib
