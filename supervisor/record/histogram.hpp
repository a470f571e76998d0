// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace handcast::supervisor {

/// A histogram of durations with logarithmic buckets, 16 per octave: percentiles are accurate to
/// 4.5 %.
class Histogram {
 public:
  /// Adds one duration; values below 1 ns count as 1 ns.
  void add(std::int64_t span_ns);
  /// Adds all durations of another histogram.
  void add(const Histogram& other);
  /// Removes all durations.
  void clear() { *this = Histogram(); }

  /// Number of durations.
  std::uint64_t count() const { return count_; }
  /// The duration that the fraction `share` (0..1) of all durations did not exceed; 0 if there are
  /// none.
  double percentile_ns(double share) const;

 private:
  static constexpr int kPerOctave = 16;
  static constexpr int kOctaves = 38;  ///< 1 ns to 275 s

  std::uint64_t count_ = 0;
  std::array<std::uint32_t, kPerOctave * kOctaves> buckets_{};
};

}  // namespace handcast::supervisor
