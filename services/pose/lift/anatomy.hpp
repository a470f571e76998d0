// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>

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

/// Half the square of the residual `r` of the unknown `column`; adds it to `equations` (null: not).
template <class Equations>
double square(int column, double r, double sd, Equations* equations) {
  const double weight = 1 / (sd * sd);
  if (equations) equations->add(column, r, weight);
  return 0.5 * weight * r * r;
}

/// The cost of the angles of a hand: usual angles, limits, and last joints that follow. The angles
/// are the unknowns from `first` on, finger by finger.
template <class Equations>
double anatomy(const std::array<std::array<double, kAngles>, kFingers>& angles, int first,
               Equations* equations) {
  constexpr std::array<double, 2> kDerivative{-kFollows, 1};
  constexpr double kFollowsWeight = 1 / (kFollowsSd * kFollowsSd);
  double cost = 0;
  for (int f = 0; f < kFingers; ++f) {
    const int column = first + f * kAngles;
    for (int a = 0; a < kAngles; ++a) {
      const AngleRange& range = f == 0 ? kThumbAngles[a] : kFingerAngles[a];
      const double angle = angles[f][a];
      cost += square(column + a, angle - range.usual, range.sd, equations);
      const double beyond = angle - std::clamp(angle, range.low, range.high);
      if (beyond != 0) cost += square(column + a, beyond, kLimitSd, equations);
    }
    if (f == 0) continue;
    const std::array<int, 2> columns{column + 2, column + 3};
    const double r = angles[f][3] - kFollows * angles[f][2];
    if (equations) equations->add(columns.data(), kDerivative.data(), 2, r, kFollowsWeight);
    cost += 0.5 * kFollowsWeight * r * r;
  }
  return cost;
}

}  // namespace handcast::pose
