// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>

#include "calib/least_squares/normal_equations.hpp"
#include "services/pose/lift/skeleton.hpp"

namespace handcast::pose {

/// What is usual and possible in one angle of a finger, in rad.
struct AngleRange {
  double usual, sd, low, high;
};
/// The ranges of Posture::angle: of the thumb, of the other fingers.
/// @{
inline constexpr std::array<AngleRange, kAngles> kThumbAngles{
    {{0, 0.35, -0.9, 0.9}, {0, 0.35, -0.8, 0.9}, {0.1, 0.4, -0.4, 1.1}, {0.2, 0.6, -0.5, 1.5}}};
inline constexpr std::array<AngleRange, kAngles> kFingerAngles{
    {{0, 0.15, -0.45, 0.45}, {0.2, 0.8, -0.5, 1.6}, {0.3, 0.9, -0.15, 1.9}, {0.2, 0.7, -0.2, 1.4}}};
/// @}
inline constexpr double kLimitSd = 0.05;  ///< how hard the limits are, rad
/// The last joint of a finger follows the middle one by this share, with this standard deviation.
/// @{
inline constexpr double kFollows = 0.6, kFollowsSd = 0.25;
/// @}

/// Adds that the unknown `column` should be less by `off`, with a standard deviation.
inline void expect(int column, double off, double sd, calib::NormalEquations& equations) {
  const double weight = 1 / (sd * sd);
  equations.matrix(column, column) += weight;
  equations.slope[column] -= weight * off;
  equations.cost += 0.5 * weight * off * off;
}

/// Adds what is known of the angles of a hand: usual angles, limits, and last joints that follow.
/// The angles are the unknowns from `first` on, finger by finger.
inline void add_anatomy(const std::array<std::array<double, kAngles>, kFingers>& angles, int first,
                        calib::NormalEquations& equations) {
  constexpr std::array kDerivative{-kFollows, 1.0};
  constexpr double kFollowsWeight = 1 / (kFollowsSd * kFollowsSd);
  for (int f = 0; f < kFingers; ++f) {
    const int column = first + f * kAngles;
    for (int a = 0; a < kAngles; ++a) {
      const AngleRange& range = f == 0 ? kThumbAngles[a] : kFingerAngles[a];
      const double angle = angles[f][a];
      expect(column + a, angle - range.usual, range.sd, equations);
      const double beyond = angle - std::clamp(angle, range.low, range.high);
      if (beyond != 0) expect(column + a, beyond, kLimitSd, equations);
    }
    if (f == 0) continue;
    const double off = angles[f][3] - kFollows * angles[f][2];
    equations.add(std::array{column + 2, column + 3}, kDerivative, -off, kFollowsWeight);
    equations.cost += 0.5 * kFollowsWeight * off * off;
  }
}

}  // namespace handcast::pose
