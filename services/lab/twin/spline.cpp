// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/spline.hpp"

#include <algorithm>
#include <utility>

namespace handcast::twin {

Spline::Spline(std::vector<double> times_s, std::vector<double> values, std::size_t channels)
    : times_s_(std::move(times_s)),
      values_(std::move(values)),
      bends_(values_.size(), 0.0),
      channels_(channels) {
  if (times_s_.size() > 2) solve_bends();
}

/// Solves the tridiagonal system h_i M_{i-1} + 2 (h_i + h_{i+1}) M_i + h_{i+1} M_{i+1} = 6
/// (slope_{i+1} - slope_i), M = 0 at both ends, by Thomas' algorithm.
void Spline::solve_bends() {
  const std::size_t last = times_s_.size() - 1;
  std::vector<double> upper(last + 1, 0.0);
  for (std::size_t i = 1; i < last; ++i) {
    const double before = times_s_[i] - times_s_[i - 1];
    const double after = times_s_[i + 1] - times_s_[i];
    const double pivot = 2 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    for (std::size_t c = 0; c < channels_; ++c) {
      const double* y = &values_[i * channels_ + c];
      const double slope_step = (y[channels_] - y[0]) / after - (y[0] - *(y - channels_)) / before;
      bends_[i * channels_ + c] =
          (6 * slope_step - before * bends_[(i - 1) * channels_ + c]) / pivot;
    }
  }
  for (std::size_t i = last - 1; i > 0; --i)
    for (std::size_t c = 0; c < channels_; ++c)
      bends_[i * channels_ + c] -= upper[i] * bends_[(i + 1) * channels_ + c];
}

void Spline::at(double time_s, double* out) const {
  const double t = std::clamp(time_s, times_s_.front(), times_s_.back());
  const auto next = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, t);
  const auto i = static_cast<std::size_t>(next - times_s_.begin()) - 1;
  const double h = times_s_[i + 1] - times_s_[i];
  const double b = (t - times_s_[i]) / h;
  const double a = 1 - b;
  const double bend_a = (a * a * a - a) * h * h / 6;
  const double bend_b = (b * b * b - b) * h * h / 6;
  const double* y = &values_[i * channels_];
  const double* m = &bends_[i * channels_];
  for (std::size_t c = 0; c < channels_; ++c)
    out[c] = a * y[c] + b * y[c + channels_] + bend_a * m[c] + bend_b * m[c + channels_];
}

}  // namespace handcast::twin
