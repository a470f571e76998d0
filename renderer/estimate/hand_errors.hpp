// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>

#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// Joints of a finger that bend.
inline constexpr int kBendsOfFinger = kLandmarksOfFinger - 1;

/// What may be wrong with a tracker's hand and with a detector's landmarks: places in one vector,
/// the state of HandEstimate. Camera space. See `docs/method.md#estimate`.
namespace error {

/// The whole hand: displaced, m; turned about its wrist, a rotation vector; too large, the
/// logarithm of the factor.
/// @{
inline constexpr std::size_t kShift = 0, kTurn = kShift + 3, kSize = kTurn + 3;
/// @}
/// By finger: the share of its flexion that is missing.
inline constexpr std::size_t kMissing = kSize + 1;
/// By finger and joint, from the knuckle: flexion, rad.
inline constexpr std::size_t kBend = kMissing + kFingers;
/// By finger: towards the thumb or away from it, rad.
inline constexpr std::size_t kSpread = kBend + kFingers * kBendsOfFinger;
/// By landmark: its joint, displaced for a moment along the camera's x and y, m.
inline constexpr std::size_t kDrift = kSpread + kFingers;
/// By landmark, in the axes of its joint, m: displaced, as the detector sees it. A part of it is
/// the tracker's error, own_share().
inline constexpr std::size_t kPlace = kDrift + 2 * kLandmarks;
/// By row of landmarks across the four fingers, from the knuckles to the tips, in the axes of their
/// joints, m: where the detector sees them, above the finger and along it. What the flesh of
/// another person does to a detector in a posture, it does to all fingers.
inline constexpr std::size_t kRow = kPlace + 3 * kLandmarks;
inline constexpr int kRows = kLandmarksOfFinger;
/// By landmark: the detector's error of the moment, px.
inline constexpr std::size_t kSeen = kRow + 2 * static_cast<std::size_t>(kRows);
inline constexpr std::size_t kCount = kSeen + 2 * kLandmarks;

/// The first number of a finger or a landmark.
/// @{
constexpr std::size_t missing_of(int finger) { return kMissing + static_cast<std::size_t>(finger); }
constexpr std::size_t bend_of(int finger, int joint) {
  return kBend + static_cast<std::size_t>(kBendsOfFinger * finger + joint);
}
constexpr std::size_t spread_of(int finger) { return kSpread + static_cast<std::size_t>(finger); }
constexpr std::size_t drift_of(int landmark) {
  return kDrift + 2 * static_cast<std::size_t>(landmark);
}
constexpr std::size_t place_of(int landmark) {
  return kPlace + 3 * static_cast<std::size_t>(landmark);
}
/// Of a landmark of the four fingers.
constexpr std::size_t row_of(int landmark) {
  return kRow + 2 * static_cast<std::size_t>((landmark - 1) % kLandmarksOfFinger);
}
constexpr std::size_t seen_of(int landmark) {
  return kSeen + 2 * static_cast<std::size_t>(landmark);
}
/// @}

}  // namespace error

/// Values of all errors.
using HandErrors = std::array<double, error::kCount>;

/// Three numbers as a vector.
inline glm::dvec3 vector_at(const HandErrors& errors, std::size_t first) {
  return {errors[first], errors[first + 1], errors[first + 2]};
}

/// Standard deviations of where a joint is, in its axes: of the tracker's error, which a person's
/// joints cause, and of where a detector sees it. Detectors define wrist and root of the thumb each
/// in their own way.
inline constexpr double kOwnPlace_m = 0.002, kSeenPlace_m = 0.0021, kSeenRoot_m = 0.008;
/// And of what it shares with the joints of the other fingers.
inline constexpr double kSeenRow_m = 0.003;
/// Of a detector's sigma, this share is where it sees the joints of one person.
inline constexpr double kSeenShare = 0.5;
/// `sigma_m`: the detector's usual sigma, on the hand.
inline double seen_place_m(int landmark, double sigma_m) {
  return std::hypot(landmark < 2 ? kSeenRoot_m : kSeenPlace_m, kSeenShare * sigma_m);
}
/// The share of error::kPlace that is most likely the tracker's.
inline double own_share(int landmark, double sigma_m) {
  const double own = kOwnPlace_m * kOwnPlace_m, seen = seen_place_m(landmark, sigma_m);
  return own / (own + seen * seen);
}

}  // namespace handcast::renderer
