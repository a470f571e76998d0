// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ipc/base/statistics.hpp"

namespace handcast::twin {

/// Samples with an exact mean and approximate percentiles. Above a fixed number, every second
/// sample is dropped, selected by order and not at random.
class Samples {
 public:
  /// Adds one.
  void add(float value) {
    if (count_ % stride_ == 0) kept_.push_back(value);
    ++count_;
    sum_ += value;
    if (kept_.size() < kMostKept) return;
    for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = kept_[2 * i];
    kept_.resize((kept_.size() + 1) / 2);
    stride_ *= 2;
  }
  /// True if there are none.
  bool empty() const { return count_ == 0; }
  /// The mean of all.
  double mean() const { return sum_ / static_cast<double>(count_); }
  /// The least of those kept that at least this share of them does not exceed.
  double percentile(double share) const { return quantile(kept_, share); }
  /// Those that were not dropped.
  const std::vector<float>& kept() const { return kept_; }

 private:
  static constexpr std::size_t kMostKept = 1 << 17;

  std::vector<float> kept_;
  std::uint64_t stride_ = 1, count_ = 0;
  double sum_ = 0;
};

}  // namespace handcast::twin
