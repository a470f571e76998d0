// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace handcast::supervisor {

/// How long something took, many times. Buckets are logarithmic, 16 to an octave: a percentile is
/// right within 4.5 %.
class Histogram {
 public:
  void add(std::int64_t span_ns);
  void add(const Histogram& other);
  void clear() { *this = Histogram(); }

  std::uint64_t count() const { return count_; }
  /// The time that `share` (0..1) of the spans did not exceed; 0 if there are none.
  double percentile_ns(double share) const;

 private:
  static constexpr int kPerOctave = 16;
  static constexpr int kOctaves = 38;  ///< 1 ns to 275 s

  std::uint64_t count_ = 0;
  std::array<std::uint32_t, kPerOctave * kOctaves> buckets_{};
};

}  // namespace handcast::supervisor
