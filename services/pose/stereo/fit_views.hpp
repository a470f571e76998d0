// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "services/pose/lift/fit.hpp"
#include "services/pose/lift/skeleton.hpp"
#include "services/pose/stereo/view.hpp"

namespace handcast::pose::stereo {

/// A hand in the space of the first camera: its posture and the lengths of its bones.
struct HandState {
  Posture posture;     ///< with its size; see depth_m
  double depth_m = 0;  ///< z of the palm joint
  /// Logarithms of the bones' lengths relative to the model's at the hand's size.
  std::array<std::array<double, kAngles>, kFingers> log_bone{};
};

/// The unknowns of a hand, in this order: rotation of the palm about the camera's axes (3), its
/// place (3), the angles finger by finger (kMoving unknowns so far, which change with time), then
/// the logarithms of the size and of the bones' lengths, finger by finger (which do not).
inline constexpr int kPlaceAt = 3, kAnglesAt = 6, kMoving = kAnglesAt + kFingers * kAngles,
                     kSizeAt = kMoving, kBonesAt = kSizeAt + 1,
                     kUnknowns = kBonesAt + kFingers * kAngles;
using Unknowns = std::array<double, kUnknowns>;

/// `state`, changed by `step`.
HandState moved(HandState state, const Unknowns& step);
/// The step from one state to another. Rotations must differ by less than half a turn.
Unknowns difference(const HandState& from, const HandState& to);
/// The joints of the hand, in the space of the first camera.
PosedHand posed(const Skeleton& skeleton, const HandState& state);

/// How alike the pictures of a hand are in both views, and so the errors of its landmarks.
struct Likeness {
  double correlation = 0;       ///< of the errors of one landmark, 0 to 0.95
  double cosine = 1, sine = 0;  ///< of the roll of the second camera relative to the first

  /// A vector in the second view's image, along the axes of the first's.
  glm::dvec2 as_first(const glm::dvec2& v) const {
    return {cosine * v.x + sine * v.y, cosine * v.y - sine * v.x};
  }
};

/// Of a hand at this place in the space of the first camera: the smaller the angle between the
/// lines of sight, the more alike are the pictures.
Likeness likeness_of(const Views& views, const glm::dvec3& hand_m);

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
