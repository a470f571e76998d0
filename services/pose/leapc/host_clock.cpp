// SPDX-License-Identifier: Apache-2.0
#include "services/pose/leapc/host_clock.hpp"

#include <cstdlib>

namespace handcast::pose::leapc {
namespace {

/// The rebaser learns the two clocks so often.
constexpr std::int64_t kUpdateEvery_ns = 100'000'000;
/// Samples older than this when they arrive are of another clock.
constexpr std::int64_t kOldest_ns = 1'000'000'000;
/// Resolution of the service's clock, and error of the map.
constexpr std::int64_t kSlack_ns = 500'000;
/// Further apart, the rebaser and the clocks themselves contradict each other.
constexpr std::int64_t kAgree_ns = 2'000'000;
/// Products with 1000 of what is less, and of differences, do not overflow.
constexpr std::int64_t kFarthest_us = INT64_MAX / 4000;

bool is_time(std::int64_t time_us) { return time_us > -kFarthest_us && time_us < kFarthest_us; }

/// The age at a time of the service's clock. A stamp of no clock if that is no time.
std::int64_t age_at_ns(std::int64_t now_us, std::int64_t stamp_us) {
  return is_time(now_us) ? (now_us - stamp_us) * 1000 : -kOldest_ns;
}

}  // namespace

HostClock::HostClock(const Functions& call, std::int64_t least_age_ns)
    : call_(call), least_age_ns_(least_age_ns) {
  if (call_.create_rebaser(&rebaser_) != kSuccess) rebaser_ = nullptr;
}

HostClock::~HostClock() {
  if (rebaser_) call_.destroy_rebaser(rebaser_);
}

/// The rebaser maps our clock to the service's, so the age is computed by the service's clock.
std::int64_t HostClock::rebased_age_ns(std::int64_t stamp_us, std::int64_t arrival_ns) {
  const std::int64_t now_us = call_.now_us();
  const std::int64_t plain_ns = age_at_ns(now_us, stamp_us);
  if (!rebaser_) return plain_ns;
  const std::int64_t ours_us = arrival_ns / 1000;
  if (arrival_ns - updated_ns_ >= kUpdateEvery_ns) {
    call_.update_rebaser(rebaser_, ours_us, now_us);
    updated_ns_ = arrival_ns;
  }
  std::int64_t theirs_us = 0;
  if (call_.rebase(rebaser_, ours_us, &theirs_us) != kSuccess) return plain_ns;
  const std::int64_t age_ns = age_at_ns(theirs_us, stamp_us) + arrival_ns % 1000;
  return std::llabs(age_ns - plain_ns) < kAgree_ns ? age_ns : plain_ns;
}

std::int64_t HostClock::origin_ns(std::int64_t stamp_us, std::int64_t arrival_ns) {
  const bool has_time = is_time(stamp_us);
  if (has_time) arrivals_.add(stamp_us * 1000, arrival_ns);
  const std::int64_t age_ns = has_time ? rebased_age_ns(stamp_us, arrival_ns) : -kOldest_ns;
  is_guessed_ = age_ns < -kSlack_ns || age_ns > kOldest_ns;
  if (!is_guessed_) return age_ns < 0 ? arrival_ns : arrival_ns - age_ns;
  if (!has_time) return arrival_ns - least_age_ns_;
  return arrivals_.earliest_arrival(stamp_us * 1000).ns - least_age_ns_;
}

}  // namespace handcast::pose::leapc
