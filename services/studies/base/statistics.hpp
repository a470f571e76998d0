// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>

namespace handcast::study {

/// What is reported of some values.
struct Summary {
  std::size_t count = 0;
  double mean = 0, median = 0;
  double population_sd = 0;  ///< divided by the count, as the paper reports it
  double sample_sd = 0;      ///< divided by one less; 0 of one value
};

/// Of one value or more.
Summary summary_of(std::span<const double> values);

/// How likely a value of Student's t is at least as far from 0 as `t`: the regularized incomplete
/// beta function (Abramowitz and Stegun 26.7.1). `freedom` > 0.
double two_sided_p(double t, double freedom);
/// The value of Student's t that is exceeded, in either direction, with the probability `p`.
double t_quantile(double p, double freedom);

/// A paired t-test (Student 1908): whether the second of two values of each subject differs.
struct PairedTest {
  double mean_difference = 0;                  ///< second minus first
  double interval_low = 0, interval_high = 0;  ///< 95 % confidence interval of the mean difference
  double t = 0;
  std::size_t freedom = 0;  ///< degrees of freedom: subjects - 1
  double p = 1;             ///< two-sided
  double effect_size = 0;   ///< mean difference per standard deviation of the differences (d_z)
};

/// Tests values of the same subjects in the same order. Empty for fewer than two subjects, and if
/// all differences are equal.
std::optional<PairedTest> paired_t_test(std::span<const double> first,
                                        std::span<const double> second);

}  // namespace handcast::study
