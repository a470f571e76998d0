// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <mutex>
#include <optional>
#include <utility>

#include "ipc/base/log.hpp"
#include "ipc/base/result.hpp"

namespace handcast::camera {

/// Why a camera sends no images, from the thread that looks after it to the one that waits for
/// them. Nothing is logged under the lock: a log that blocks must not delay the waiting thread.
class Trouble {
 public:
  /// Empty if images should come. Any thread.
  std::optional<Error> why() const {
    const std::scoped_lock lock(mutex_);
    return why_;
  }
  /// Sets it, and logs it if it is not what was said last. What is not the fault of a setting may
  /// pass: it becomes a timeout, with which a service goes on.
  void say(Error why) {
    if (why.code != Errc::bad_config) why.code = Errc::timeout;
    const auto before = this->why();
    if (!before || before->what != why.what) log::warning("{}", why.what);
    set(std::move(why));
  }
  /// Images come.
  void end() { set(std::nullopt); }

 private:
  void set(std::optional<Error> why) {
    const std::scoped_lock lock(mutex_);
    why_ = std::move(why);
  }

  mutable std::mutex mutex_;
  std::optional<Error> why_;
};

}  // namespace handcast::camera
