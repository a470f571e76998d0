// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace handcast::projector {

/// The longest time that m drawings in a row took lately, for each m up to the number of sub-frames
/// of an output frame: slow drawings come in bursts, so that m times the slowest one would be too
/// much, and m times the usual one too little.
class LongestRuns {
 public:
  /// For up to `most` drawings in a row. Starts as if each had taken `first_ns`.
  LongestRuns(int most, std::int64_t first_ns)
      : last_ns_(static_cast<std::size_t>(most), first_ns), longest_ns_(last_ns_.size()) {
    for (auto& runs : recent_ns_) runs.assign(last_ns_.size(), 0);
    for (std::size_t i = 0; i < longest_ns_.size(); ++i)
      longest_ns_[i] = static_cast<std::int64_t>(i + 1) * first_ns;
  }

  /// The longest time of `drawings` (1 to `most`) in a row, in the 31 output frames before the last
  /// begin_output_frame().
  std::int64_t of(int drawings) const {
    return longest_ns_[static_cast<std::size_t>(drawings - 1)];
  }

  /// Adds the time of a drawing.
  void add(std::int64_t time_ns) {
    last_ns_[count_++ % last_ns_.size()] = time_ns;
    auto& runs = recent_ns_[output_frames_ % recent_ns_.size()];
    std::int64_t sum_ns = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      sum_ns += last_ns_[(count_ + last_ns_.size() - 1 - i) % last_ns_.size()];
      runs[i] = std::max(runs[i], sum_ns);
    }
  }
  /// Takes the drawings of the output frame before into account.
  void begin_output_frame() {
    if (count_ == 0) return;
    for (std::size_t i = 0; i < longest_ns_.size(); ++i) {
      longest_ns_[i] = 0;
      for (const auto& runs : recent_ns_) longest_ns_[i] = std::max(longest_ns_[i], runs[i]);
    }
    auto& oldest = recent_ns_[++output_frames_ % recent_ns_.size()];
    std::ranges::fill(oldest, 0);
  }

 private:
  std::vector<std::int64_t> last_ns_;  ///< the times of the last drawings, a ring
  /// The longest runs that ended in each of the last output frames; run i has i + 1 drawings.
  std::array<std::vector<std::int64_t>, 31> recent_ns_;
  std::vector<std::int64_t> longest_ns_;  ///< of all recent_ns_
  std::size_t count_ = 0, output_frames_ = 0;
};

}  // namespace handcast::projector
