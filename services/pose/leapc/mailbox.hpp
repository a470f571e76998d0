// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"

namespace handcast::pose::leapc {

/// Holds the newest sample until it is taken, and says why there is none. Any thread.
class Mailbox {
 public:
  /// Replaces the sample, or the error, that is waiting.
  void put(Result<msg::HandPoses> sample);
  /// Why no samples come; empty: they should.
  void say(std::string trouble);
  /// The newest sample, as soon as there is one. Errors: timeout, with the trouble; the error that
  /// was put.
  Result<msg::HandPoses> take(Deadline deadline);

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::optional<Result<msg::HandPoses>> newest_;
  std::string trouble_;
};

}  // namespace handcast::pose::leapc
