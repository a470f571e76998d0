// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "calib/solve/pair/pair_fit.hpp"
#include "calib/solve/pair/pair_solve.hpp"

namespace handcast::calib {

/// Poses of the second camera as other views and other lenses would have given them: a bootstrap of
/// kResamples (lens/spread.hpp). Each draws as many views as there are, with repetition, draws the
/// error of each lens by its covariance, and takes one Gauss-Newton step from the solution. A fit
/// with measured lenses is off by their errors, too, which are the same in all views: the views
/// alone do not show them.
std::vector<Pose> resample(std::span<const PairPoints> views, const KnownLenses& lenses,
                           const PairSolution& solution);

/// The spreads of a fit by these poses; sets apart_mm, place_mm, turn_deg and middle_mm. `views`:
/// how many there are. The intervals are those of Student's t; tests/bench/calib_pair.cpp measures
/// how often they hold the truth.
void describe_spread(const std::vector<Pose>& poses, std::size_t views, PairFit& fit);

}  // namespace handcast::calib
