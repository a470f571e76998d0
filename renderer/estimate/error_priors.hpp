// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "renderer/estimate/articulated_hand.hpp"
#include "renderer/estimate/hand_errors.hpp"

/// @file
/// How large errors are and how long they last: all constants of the estimate but those of joints
/// (hand_errors.hpp). They are those of a careful installation (docs/method.md#twin).
namespace handcast::renderer {

inline constexpr double kDegree = std::numbers::pi / 180;

/// Numbers of one kind: their standard deviation, and the time constant with which they change, as
/// an Ornstein-Uhlenbeck process.
struct ErrorPrior {
  std::size_t first;
  int count;
  double sd, lasts_s;

  /// The share of a value that is left after a time.
  double kept(double seconds) const { return std::exp(-seconds / lasts_s); }
  /// The variance that a time adds to what is left.
  double added(double seconds) const {
    const double share = kept(seconds);
    return sd * sd * (1 - share * share);
  }
};

/// How long errors of an installation or a person, of a size, of a posture, and of a moment last,
/// and at least those of the tracker of more than three standard deviations: a finger that is taken
/// for another stays so until it jumps back. Such errors of the detector last. A size that lasted
/// longer would follow a detector that sees other flesh too small.
inline constexpr double kLasting_s = 60, kSize_s = 3, kPosture_s = 0.7, kDrift_s = 0.3,
                        kSeen_s = 0.35, kGross_s = 2;
/// By this share, a detector's errors change more slowly while a hand rests: it sees the same.
inline constexpr double kSeenAtRest = 0.9;

/// Where the tracker's calibration and its idea of the hand's size put the hand, and the fingers;
/// where the detector sees rows of joints.
inline constexpr std::array kErrorPriors{
    ErrorPrior{error::kShift, 2, 10e-3, kLasting_s},
    ErrorPrior{error::kShift + 2, 1, 2.5e-3, kLasting_s},
    ErrorPrior{error::kTurn, 3, 1.5 * kDegree, kLasting_s},
    ErrorPrior{error::kSize, 1, 0.03, kSize_s},
    ErrorPrior{error::kMissing, kFingers, 0.1, kLasting_s},
    ErrorPrior{error::kSpread, kFingers, 2 * kDegree, kPosture_s},
    ErrorPrior{error::kRow, 2 * error::kRows, kSeenRow_m, kPosture_s},
};
/// How far a tracker that has jumped may put the hand beside its place.
inline constexpr double kJump_m = 0.05;
/// Of a bend: what the joints of a finger share, and each its own.
inline constexpr double kSharedBend_rad = 12 * kDegree, kOwnBend_rad = 6 * kDegree;
/// Trackers guess folded fingers: their bends are so much less certain.
inline constexpr double kFoldedBend = 1.5;
/// Of a joint, for a moment. Trackers err by less; this also holds what bends cannot explain.
inline constexpr double kDrift_m = 7e-3;

/// Of a finger that the tracker alone has bent, the bend is uncertain by this share of it.
inline constexpr double kUnbent = 0.3;

/// Landmarks of images that are closer than this say the same.
inline constexpr std::int64_t kShortest_ns = 9'000'000;
/// Of a detector's sigma, this share is noise of one image; the rest lasts kSeen_s. Never less than
/// the least noise, which the pixels cause.
inline constexpr double kWhiteShare = 0.35, kLeastNoise_px = 0.6;
/// Of a detector that reports no sigma.
inline constexpr double kUnknownSigma_px = 3;
/// A landmark that is further off than so many standard deviations counts less. If half of them are
/// this far off, they are not of the tracker's hand.
inline constexpr double kHuber = 3, kContradicted = 6;
/// A tracker that landmarks contradict for so long has been moved.
inline constexpr std::int64_t kMoved_ns = 1'000'000'000;
/// Where a finger may be that the tracker has moved abruptly: bent, spread, displaced.
inline constexpr double kFreedBend_rad = 40 * kDegree, kFreedSpread_rad = 20 * kDegree,
                        kFreed_m = 0.02;

/// The prior of a joint's place. `sigma_m`: see seen_place_m().
inline ErrorPrior place_prior(int landmark, double sigma_m) {
  return {error::place_of(landmark), 3, std::hypot(kOwnPlace_m, seen_place_m(landmark, sigma_m)),
          kLasting_s};
}

/// Calls `visit` with the priors of all errors but bends and those of the detector in an image.
template <class Visit>
void for_priors(double sigma_m, const Visit& visit) {
  for (const auto& prior : kErrorPriors) visit(prior);
  for (int landmark = 0; landmark < kLandmarks; ++landmark) visit(place_prior(landmark, sigma_m));
  visit(ErrorPrior{error::kDrift, 2 * kLandmarks, kDrift_m, kDrift_s});
}

/// The prior of a landmark's error, px.
inline ErrorPrior seen_prior(int landmark, double sigma_px, double lasts_s) {
  return {error::seen_of(landmark), 2, sigma_px, lasts_s};
}

/// 0 for a finger that is open, 1 for one that is folded.
inline double folded(const std::array<double, kBendsOfFinger>& flexions_rad) {
  constexpr double kOpen_rad = 1.2, kFolded_rad = 2.4;
  const double sum_rad = flexions_rad[0] + flexions_rad[1] + flexions_rad[2];
  return std::clamp((sum_rad - kOpen_rad) / (kFolded_rad - kOpen_rad), 0.0, 1.0);
}

}  // namespace handcast::renderer
