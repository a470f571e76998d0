// SPDX-License-Identifier: Apache-2.0
#include "services/preview/series.hpp"

#include "ipc/base/clock.hpp"

namespace handcast::preview {

void Series::add(float value) {
  if (values_.size() == most_) values_.erase(values_.begin());
  values_.push_back(value);
}

void RateMeter::saw(std::uint64_t sequence, std::int64_t published_ns) {
  if (first_ == 0 || sequence < last_) first_ = sequence, first_ns_ = published_ns;
  last_ = sequence;
  last_ns_ = published_ns;
}

double RateMeter::take_hz() {
  const auto span_ns = last_ns_ - first_ns_;
  const auto hz = span_ns > 0 ? static_cast<double>(last_ - first_) / ns_to_seconds(span_ns) : 0.0;
  first_ = last_;
  first_ns_ = last_ns_;
  return hz;
}

}  // namespace handcast::preview
