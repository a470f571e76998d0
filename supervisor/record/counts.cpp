// SPDX-License-Identifier: Apache-2.0
#include "supervisor/record/counts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace handcast::supervisor {

void Histogram::add(std::int64_t span_ns) {
  const double octaves = std::log2(static_cast<double>(std::max<std::int64_t>(span_ns, 1)));
  const auto bucket = static_cast<std::size_t>(octaves * kPerOctave);
  ++buckets_[std::min(bucket, buckets_.size() - 1)];
  ++count_;
}

void Histogram::add(const Histogram& other) {
  for (std::size_t i = 0; i < buckets_.size(); ++i) buckets_[i] += other.buckets_[i];
  count_ += other.count_;
}

double Histogram::percentile_ns(double share) const {
  if (count_ == 0) return 0;
  const double wanted = std::max(1.0, std::ceil(share * static_cast<double>(count_)));
  double seen = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    seen += buckets_[i];
    if (seen >= wanted) return std::exp2((static_cast<double>(i) + 0.5) / kPerOctave);
  }
  return 0;
}

void SlowFrames::add(std::int64_t span_ns, const msg::FrameDelay& delay) {
  if (count() == kKept) {
    if (span_ns <= least_ns()) return;
    std::ranges::pop_heap(slowest_, std::greater<>(), &Frame::span_ns);
    slowest_.pop_back();
  }
  slowest_.push_back({span_ns, delay});
  std::ranges::push_heap(slowest_, std::greater<>(), &Frame::span_ns);
}

SlowFrames::Causes SlowFrames::causes() const {
  constexpr std::int64_t kShare = 10;  // off the processor for a tenth of the frame
  Causes causes;
  for (const auto& [span_ns, delay] : slowest_) {
    const bool is_off = std::int64_t{delay.off_cpu_us} * 1000 * kShare >= span_ns;
    ++(is_off ? (delay.preemptions > 0 ? causes.preempted : causes.interrupted)
              : (delay.faults > 0 ? causes.faulted : causes.own));
  }
  return causes;
}

}  // namespace handcast::supervisor
