// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

namespace handcast::twin {

/// Natural cubic splines of several channels over the same times: twice differentiable everywhere.
class Spline {
 public:
  /// An empty spline, which must not be evaluated.
  Spline() = default;
  /// `values` holds a row of `channels` numbers per time. At least two times, ascending.
  Spline(std::vector<double> times_s, std::vector<double> values, std::size_t channels);

  /// Writes all channels at a time to `out`. Before the first and after the last time: those
  /// values.
  void at(double time_s, double* out) const;
  /// Time from the first sample to the last.
  double duration_s() const { return times_s_.back() - times_s_.front(); }
  /// Numbers that at() writes.
  std::size_t channels() const { return channels_; }

 private:
  void solve_bends();

  std::vector<double> times_s_, values_;
  std::vector<double> bends_;  ///< second derivatives, in the layout of values_
  std::size_t channels_ = 0;
};

}  // namespace handcast::twin
