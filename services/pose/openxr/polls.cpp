// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/polls.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"

namespace handcast::pose::openxr {

Polls::Polls(double rate_hz, std::int64_t start_ns)
    : period_ns_(seconds_to_ns(1 / rate_hz)), start_ns_(start_ns), due_ns_(start_ns + period_ns_) {}

std::int64_t Polls::next_ns(std::int64_t now_ns) {
  const std::int64_t late_ns = now_ns - due_ns_;
  if (late_ns > period_ns_ / 2) due_ns_ += (late_ns / period_ns_ + 1) * period_ns_;
  return due_ns_;
}

void Polls::made(bool is_new) {
  // A runtime that has no hand for long need not be listened to so closely.
  const std::int64_t listen_ns =
      repeated_ns_ < 4 * period_ns_ ? kListen_ns : std::max(kListen_ns, period_ns_ / 4);
  const std::int64_t step_ns = is_new ? period_ns_ : listen_ns;
  repeated_ns_ = is_new ? 0 : repeated_ns_ + step_ns;
  due_ns_ += step_ns;
}

std::uint64_t Polls::number(std::int64_t poll_ns) const {
  return static_cast<std::uint64_t>((poll_ns - start_ns_) / period_ns_ - 1);
}

}  // namespace handcast::pose::openxr
