// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::ipc {

/// Turns the futex of a ring into an eventfd, for programs that wait in epoll: a thread waits on
/// the futex and makes the descriptor readable when there is a new message. It takes one wake-up
/// (about 30 us) more than Wait::futex.
class WakeBridge {
 public:
  /// Starts the thread, which calls `wait` in a loop. `wait` blocks for at most 100 ms and returns
  /// true if there is a message that it has not reported yet. Errors: unavailable (no descriptor or
  /// no thread).
  static Result<std::unique_ptr<WakeBridge>> start(std::function<bool()> wait);
  ~WakeBridge();  ///< Stops the thread, which takes up to 100 ms.
  WakeBridge(const WakeBridge&) = delete;

  /// The eventfd, owned by this object.
  int fd() const { return event_.get(); }
  /// Makes the descriptor unreadable. Call it before looking at the ring, never after: only later
  /// messages make it readable again.
  void clear();

 private:
  explicit WakeBridge(UniqueFd event) : event_(std::move(event)) {}
  UniqueFd event_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace handcast::ipc
