// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/series.hpp"

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
  // Any two times may have been reported: as integers, they might overflow.
  const double span_s = 1e-9 * (static_cast<double>(last_ns_) - static_cast<double>(first_ns_));
  const double hz = span_s > 0 ? static_cast<double>(last_ - first_) / span_s : 0.0;
  first_ = last_;
  first_ns_ = last_ns_;
  return hz;
}

}  // namespace handcast::preview
