// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

namespace handcast::twin {

/// The natural cubic spline through many channels at once: as smooth as its samples, twice
/// differentiable everywhere.
class Spline {
 public:
  Spline() = default;
  /// `values`: one row of `channels` numbers for each time; times ascend, at least two.
  Spline(std::vector<double> times_s, std::vector<double> values, std::size_t channels);

  /// All channels at a time; outside the samples: the nearest end.
  void at(double time_s, double* out) const;
  double duration_s() const { return times_s_.back() - times_s_.front(); }
  std::size_t channels() const { return channels_; }

 private:
  void solve_bends();

  std::vector<double> times_s_, values_,
      bends_;  ///< bends: second derivatives, laid out as the values
  std::size_t channels_ = 0;
};

}  // namespace handcast::twin
