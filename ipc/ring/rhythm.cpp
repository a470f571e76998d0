// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/rhythm.hpp"

#include <cstdlib>

namespace handcast::ipc {
namespace {

// Time constant of the exponential averages, in messages.
constexpr int kAverageOver = 8;
// The averages are used after this many periods.
constexpr int kFirstPeriods = 4;
// Below this period, waking up costs more than polling.
constexpr std::int64_t kShortestPeriod_ns = 100'000;
// Above this period, precise timing gains nothing.
constexpr std::int64_t kLongestPeriod_ns = 500'000'000;
// How early a sleeper must wake up: 30 to 45 us were measured, plus a timer slack of 50 us.
constexpr std::int64_t kLead_ns = 90'000;
// How long a reader polls for a late message.
constexpr std::int64_t kPatience_ns = 400'000;
// Above this jitter a message that comes early is seen so late that the futex is better.
constexpr std::int64_t kMostJitter_ns = 250'000;
// The averages restart after a gap of more than this many periods.
constexpr std::int64_t kPause = 4;
// Later time stamps are rejected: sums with them would overflow.
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 62;

}  // namespace

void Rhythm::received(std::uint64_t sequence, std::int64_t published_ns) {
  const bool plausible = published_ns > 0 && published_ns < kLatest_ns &&
                         sequence > last_sequence_ && published_ns > last_ns_;
  const auto period_ns =
      plausible ? (published_ns - last_ns_) / static_cast<std::int64_t>(sequence - last_sequence_)
                : 0;
  last_sequence_ = sequence;
  last_ns_ = plausible ? published_ns : 0;
  const bool paused = periods_ > 0 && period_ns > kPause * period_ns_;
  if (period_ns < kShortestPeriod_ns || period_ns > kLongestPeriod_ns || paused) {
    periods_ = 0;
    return;
  }
  if (periods_ == 0) {
    period_ns_ = period_ns;
    jitter_ns_ = 0;
  }
  if (periods_ < kFirstPeriods) ++periods_;
  jitter_ns_ += (std::llabs(period_ns - period_ns_) - jitter_ns_) / kAverageOver;
  period_ns_ += (period_ns - period_ns_) / kAverageOver;
}

std::optional<Rhythm::Window> Rhythm::window() const {
  if (periods_ < kFirstPeriods || jitter_ns_ > kMostJitter_ns) return std::nullopt;
  const auto due_ns = last_ns_ + period_ns_;
  return Window{due_ns - kLead_ns - jitter_ns_, due_ns + kPatience_ns};
}

}  // namespace handcast::ipc
