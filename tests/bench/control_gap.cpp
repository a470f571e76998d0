// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/control_gap.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "tests/bench/rings_process.hpp"

namespace handcast::bench {
namespace {

constexpr std::int64_t kLookEvery_ns = 200'000;

}  // namespace

GapWatch::GapWatch(ipc::RingView view) : view_(std::move(view)), thread_([this] { look(); }) {}

GapWatch::~GapWatch() {
  ends_ = true;
  thread_.join();
}

double GapWatch::longest_ms() const {
  const auto newest_ns = newest_ns_.load();
  return ns_to_ms(std::max(longest_ns_.load(), newest_ns == 0 ? 0 : now_ns() - newest_ns));
}

double GapWatch::pause_ms() const { return ns_to_ms(pause_ns_.load()); }

void GapWatch::look() {
  become_real_time();  // only this thread
  std::uint64_t sequence = 0;
  for (; !ends_; sleep_until_ns(now_ns() + kLookEvery_ns)) {
    if (view_.sequence() == sequence) continue;
    const auto seen = view_.look();
    if (seen.newest_published_ns == 0) continue;  // it was overwritten meanwhile
    const auto gap_ns = seen.newest_published_ns - newest_ns_;
    if (newest_ns_ != 0) longest_ns_ = std::max(longest_ns_.load(), gap_ns);
    if (newest_ns_ != 0 && seen.epoch != epoch_)
      pause_ns_ = std::max(pause_ns_.load(), seen.pause_ns);
    sequence = seen.sequence;
    newest_ns_ = seen.newest_published_ns;
    epoch_ = seen.epoch;
  }
}

}  // namespace handcast::bench
