// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace handcast::study {
namespace {

/// The continued fraction of the incomplete beta function, by Lentz's method (DLMF 8.17.22).
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  const auto not_zero = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double c = 1, d = 1 / not_zero(1 - (a + b) * x / (a + 1)), fraction = d;
  for (int m = 1; m < 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double change = 1;
    for (const double term : {even, odd}) {
      d = 1 / not_zero(1 + term * d);
      c = not_zero(1 + term / c);
      change = c * d;
      fraction *= change;
    }
    if (std::abs(change - 1) < 1e-15) break;
  }
  return fraction;
}

/// The regularized incomplete beta function I_x(a, b) (DLMF 8.17.2).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  if (x > (a + 1) / (a + b + 2)) return 1 - incomplete_beta(b, a, 1 - x);
  const double log_front =
      std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
  return std::exp(log_front) / a * beta_fraction(a, b, x);
}

}  // namespace

Summary summary_of(std::span<const double> values) {
  Summary summary{.count = values.size()};
  const auto count = static_cast<double>(values.size());
  for (const double value : values) summary.mean += value / count;
  double squares = 0;
  for (const double value : values) squares += (value - summary.mean) * (value - summary.mean);
  summary.population_sd = std::sqrt(squares / count);
  summary.sample_sd = values.size() > 1 ? std::sqrt(squares / (count - 1)) : 0;
  std::vector<double> ordered(values.begin(), values.end());
  std::ranges::sort(ordered);
  const std::size_t middle = ordered.size() / 2;
  summary.median =
      ordered.size() % 2 ? ordered[middle] : 0.5 * (ordered[middle - 1] + ordered[middle]);
  return summary;
}

double two_sided_p(double t, double freedom) {
  return incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t));
}

double t_quantile(double p, double freedom) {
  double low = 0, high = 1e6;
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (low + high);
    (two_sided_p(middle, freedom) > p ? low : high) = middle;
  }
  return low;
}

std::optional<PairedTest> paired_t_test(std::span<const double> first,
                                        std::span<const double> second) {
  if (first.size() < 2 || first.size() != second.size()) return {};
  std::vector<double> differences(first.size());
  std::ranges::transform(second, first, differences.begin(), std::minus<>());
  const Summary summary = summary_of(differences);
  if (!(summary.sample_sd > 0)) return {};
  const auto count = static_cast<double>(first.size());
  const double error = summary.sample_sd / std::sqrt(count);
  PairedTest test{.mean_difference = summary.mean,
                  .t = summary.mean / error,
                  .freedom = first.size() - 1,
                  .effect_size = summary.mean / summary.sample_sd};
  test.p = two_sided_p(test.t, count - 1);
  const double reach = t_quantile(0.05, count - 1) * error;
  test.interval_low = summary.mean - reach;
  test.interval_high = summary.mean + reach;
  return test;
}

}  // namespace handcast::study
