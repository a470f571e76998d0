// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "services/pose/lift/fit.hpp"
#include "services/pose/stereo/hand_state.hpp"
#include "services/pose/stereo/view.hpp"

namespace handcast::pose::stereo {

/// What each view sees of a hand at one time; empty: nothing.
using SeenInViews = std::array<std::optional<SeenHand>, kViews>;

/// What is known of a hand before its landmarks.
struct HandPrior {
  HandState mean;       ///< the expected state
  Unknowns variance{};  ///< of the state about it; 0: nothing is known
};

/// A state and its cost.
struct HandFit {
  HandState state;      ///< the state
  double cost = 0;      ///< half the sum of squared, normalised residuals (Huber's, beyond 3 sigma)
  Unknowns variance{};  ///< of the state
  double sigmas = 0;    ///< root mean square of the landmarks' residuals, in sigmas per axis
};

/// The hand whose joints are projected onto the landmarks of all views, weighted by their sigmas:
/// nonlinear least squares (Levenberg-Marquardt, at most `steps` steps from `start`) over
/// `docs/method.md#stereo`. With both views, the landmarks are triangulated in it; with one, the
/// bones' lengths and the prior give the depth. A pure function.
HandFit fit_views(const Skeleton& skeleton, const Views& views, const SeenInViews& seen,
                  const HandPrior& prior, const HandState& start, int steps);

}  // namespace handcast::pose::stereo
