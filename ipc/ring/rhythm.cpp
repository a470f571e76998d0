// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/rhythm.hpp"

#include <cstdlib>

namespace handcast::ipc {
namespace {

constexpr int kAverageOver = 8;                       // messages, exponentially
constexpr int kFirstPeriods = 4;                      // before the averages are trusted
constexpr std::int64_t kShortestPeriod_ns = 100'000;  // below, waking up costs more than watching
constexpr std::int64_t kLongestPeriod_ns = 500'000'000;  // above, being on time gains nothing
constexpr std::int64_t kLead_ns =
    90'000;  // what a sleeper needs to be awake: measured 30-45 us, and a timer's slack of 50
constexpr std::int64_t kPatience_ns = 400'000;  // how long a late message is watched for
constexpr std::int64_t kMostJitter_ns =
    250'000;  // a message this early would be seen this late: then rather be woken
constexpr std::int64_t kPause = 4;  // periods without a message: the averages start again
constexpr std::int64_t kLatest_ns =
    std::int64_t{1} << 62;  // later stamps are nonsense, and sums with them would overflow

}  // namespace

void Rhythm::heard(std::uint64_t sequence, std::int64_t published_ns) {
  const bool plausible = published_ns > 0 && published_ns < kLatest_ns &&
                         sequence > last_sequence_ && published_ns > last_ns_;
  const auto period_ns =
      plausible ? (published_ns - last_ns_) / static_cast<std::int64_t>(sequence - last_sequence_)
                : 0;
  last_sequence_ = sequence;
  last_ns_ = plausible ? published_ns : 0;
  const bool paused = heard_ > 0 && period_ns > kPause * period_ns_;
  if (period_ns < kShortestPeriod_ns || period_ns > kLongestPeriod_ns || paused) {
    heard_ = 0;
    return;
  }
  if (heard_ == 0) {
    period_ns_ = period_ns;
    jitter_ns_ = 0;
  }
  if (heard_ < kFirstPeriods) ++heard_;
  jitter_ns_ += (std::llabs(period_ns - period_ns_) - jitter_ns_) / kAverageOver;
  period_ns_ += (period_ns - period_ns_) / kAverageOver;
}

std::optional<Rhythm::Window> Rhythm::window() const {
  if (heard_ < kFirstPeriods || jitter_ns_ > kMostJitter_ns) return std::nullopt;
  const auto due_ns = last_ns_ + period_ns_;
  return Window{due_ns - kLead_ns - jitter_ns_, due_ns + kPatience_ns};
}

}  // namespace handcast::ipc
