// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/lasting.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::calib {
namespace {

/// The logarithm of the restricted likelihood of a variance and a time constant, by a Kalman filter
/// for the errors about a mean of 0, whose innovations then give the mean (de Jong 1991).
double log_likelihood(const std::vector<Measured>& series, double variance, double kept) {
  double at = 0, of_mean = 0, spread = variance;  // predicted; how it depends on the mean
  double logs = 0, squares = 0, cross = 0, information = 0;
  for (const auto& measured : series) {
    if (std::isfinite(measured.variance)) {
      const double total = spread + measured.variance, gain = spread / total;
      const double off = measured.value - at, slope = 1 - of_mean;
      logs += std::log(total);
      squares += off * off / total;
      cross += off * slope / total;
      information += slope * slope / total;
      at += gain * off;
      of_mean += gain * slope;
      spread *= 1 - gain;
    }
    at *= kept;
    of_mean *= kept;
    spread = kept * kept * spread + (1 - kept * kept) * variance;
  }
  if (!(information > 0)) return 0;
  return -(logs + std::log(information) + squares - cross * cross / information) / 2;
}

/// The variance of the mean of an exponentially correlated process, for a variance of 1.
double of_mean(double lasting_s, double time_s) {
  const double share = lasting_s / time_s;
  return 2 * share * (1 - share * (1 - std::exp(-1 / share)));
}

/// The same without what independent blocks of time say of it.
double unseen_of_mean(double lasting_s, double time_s, double block_s) {
  const double whole = of_mean(lasting_s, time_s);
  const double seen = (of_mean(lasting_s, block_s) - whole) * block_s / time_s;
  return std::max(whole - std::max(seen, 0.), 0.);
}

/// The mean of squares of what was measured, about the mean of each coordinate.
double spread_of(std::span<const std::vector<Measured>> coordinates) {
  double squares = 0, freedom = 0;
  for (const auto& series : coordinates) {
    double count = 0, sum = 0, own = 0;
    for (const auto& m : series) {
      if (!std::isfinite(m.variance)) continue;
      ++count;
      sum += m.value;
      own += m.value * m.value;
    }
    if (count < 2) continue;
    squares += own - sum * sum / count;
    freedom += count - 1;
  }
  return freedom > 0 ? squares / freedom : 0;
}

double on_grid(double low, double high, int i, int count) {
  return low * std::pow(high / low, static_cast<double>(i) / (count - 1));
}

}  // namespace

double variance_of_mean(std::span<const std::vector<Measured>> coordinates, double step_s,
                        double block_s) {
  constexpr int kTimes = 14, kVariances = 16;
  constexpr double kLeast = 0.1, kMost = 6;  // of what was measured
  const double spread = spread_of(coordinates);
  if (!(spread > 0)) return 0;
  const double time_s = step_s * static_cast<double>(coordinates.front().size());
  std::vector<double> logs, variances;
  for (int t = 0; t < kTimes; ++t) {
    const double lasting_s = on_grid(kShortest_s, kLongest_s, t, kTimes);
    for (int v = 0; v < kVariances; ++v) {
      const double variance = spread * on_grid(kLeast, kMost, v, kVariances);
      logs.push_back(0);
      for (const auto& series : coordinates)
        logs.back() += log_likelihood(series, variance, std::exp(-step_s / lasting_s));
      variances.push_back(variance * unseen_of_mean(lasting_s, time_s, block_s));
    }
  }
  const double most = *std::ranges::max_element(logs);
  double sum = 0, mean = 0;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const double weight = std::exp(logs[i] - most);
    sum += weight;
    mean += weight * variances[i];
  }
  return mean / sum;
}

}  // namespace handcast::calib
