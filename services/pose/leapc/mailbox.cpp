// SPDX-License-Identifier: Apache-2.0
#include "services/pose/leapc/mailbox.hpp"

#include <chrono>
#include <utility>

namespace handcast::pose::leapc {

void Mailbox::put(Result<msg::HandPoses> sample) {
  {
    const std::scoped_lock lock(mutex_);
    newest_ = std::move(sample);
  }
  came_.notify_one();
}

void Mailbox::say(std::string trouble) {
  const std::scoped_lock lock(mutex_);
  trouble_ = std::move(trouble);
}

Result<msg::HandPoses> Mailbox::take(Deadline deadline) {
  const std::chrono::steady_clock::time_point until(std::chrono::nanoseconds(deadline.time_ns()));
  std::unique_lock lock(mutex_);
  came_.wait_until(lock, until, [this] { return newest_.has_value(); });
  if (newest_) return *std::exchange(newest_, std::nullopt);
  return fail(Errc::timeout, trouble_.empty() ? "no sample before the deadline" : trouble_);
}

}  // namespace handcast::pose::leapc
