// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

namespace handcast::calib {

/// A coordinate of the tracker's common error at one time, as the points of a hand show it.
struct Measured {
  double value = 0;
  double variance = 0;  ///< of the measurement; infinite if there is none
};

/// How far the mean of a coordinate over the whole time is off, because errors last: a variance.
/// Nobody sees that mean, since it is a part of the pose that was found. It follows from how long
/// the errors last and how large they are, and these from how the coordinates change. Method: each
/// coordinate is a first-order autoregressive process about an unknown mean; the time constant and
/// the variance, the same for all coordinates, are weighted by their restricted likelihood
/// (Patterson and Thompson 1971) on a grid. Errors that last much longer than the recording cannot
/// be told from a constant one. `step_s`: between two times; all coordinates have as many. What a
/// resampling of blocks of `block_s` sees of that variance is left out.
double variance_of_mean(std::span<const std::vector<Measured>> coordinates, double step_s,
                        double block_s);

/// The time constants of errors that are considered.
inline constexpr double kShortest_s = 0.2, kLongest_s = 10;

}  // namespace handcast::calib
