// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

namespace handcast {

// Values are a container, of which these functions take a copy, or a span, whose order they change.

/// Standard deviation of normally distributed values per median of their distances from the middle.
inline constexpr double kSigmaPerMad = 1.4826;

/// The value of this rank in ascending order, from 0. There must be more values.
template <class Values>
auto ranked(Values values, std::size_t rank) {
  const auto at = std::begin(values) + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(std::begin(values), at, std::end(values));
  return *at;
}

/// The median, of an even number of values the upper one; 0 of none.
template <class Values>
auto median(Values values) {
  using Value = decltype(ranked(values, 0));
  const std::size_t count = std::size(values);
  return count > 0 ? ranked(std::move(values), count / 2) : Value{};
}

/// The least value that at least this share of the values does not exceed; 0 of none.
template <class Values>
auto quantile(Values values, double share) {
  using Value = decltype(ranked(values, 0));
  const auto count = static_cast<double>(std::size(values));
  if (count == 0) return Value{};
  const double rank = std::clamp(std::ceil(share * count), 1.0, count) - 1;
  return ranked(std::move(values), static_cast<std::size_t>(rank));
}

/// The 97.5 % quantile of Student's t (Cornish and Fisher's expansion; Abramowitz and Stegun
/// 26.7.5). Off by less than 1 % from 4 degrees of freedom on.
inline double students_t(double freedom) {
  constexpr double z = 1.959964;
  constexpr double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4 * freedom) + (5 * z5 + 16 * z3 + 3 * z) / (96 * freedom * freedom) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * freedom * freedom * freedom);
}

}  // namespace handcast
