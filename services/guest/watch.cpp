// SPDX-License-Identifier: Apache-2.0
#include "services/guest/watch.hpp"

#include <fmt/format.h>

#include <utility>

#include "ipc/base/clock.hpp"

namespace handcast::guest {

Watch::Watch(ipc::RingView ring, const config::External& settings, std::int64_t started_ns)
    : ring_(std::move(ring)),
      silent_s_(settings.silent_s),
      first_s_(config::first_message_within_s(settings)),
      before_(ring_.sequence()),
      newest_(before_),
      heard_ns_(started_ns) {}

bool Watch::has_sent() { return ring_.sequence() != before_; }

std::optional<std::string> Watch::fault(std::int64_t now_ns) {
  if (const auto newest = ring_.sequence(); std::exchange(newest_, newest) != newest)
    heard_ns_ = now_ns;
  const bool is_first = newest_ == before_;
  const double limit_s = is_first ? first_s_ : silent_s_;
  if (silent_s_ == 0 || now_ns - heard_ns_ < seconds_to_ns(limit_s)) return std::nullopt;
  return fmt::format("it has sent nothing to {} for {:g} s{}", ring_.stream(), limit_s,
                     is_first ? " since it was started" : "");
}

}  // namespace handcast::guest
