// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::ipc {

/// Turns a ring's futex into an eventfd, for programs that wait in epoll for many things at once: a
/// thread that sleeps until `wait` says that something is new, then makes the descriptor readable.
/// Costs one more wake-up (some 30 us) than Wait::futex.
class WakeBridge {
 public:
  /// `wait` blocks up to 100 ms and returns whether there is a message that it has not told of yet;
  /// called on the bridge's thread. Errors: unavailable (no descriptor, no thread).
  static Result<std::unique_ptr<WakeBridge>> start(std::function<bool()> wait);
  ~WakeBridge();  ///< within 100 ms
  WakeBridge(const WakeBridge&) = delete;

  int fd() const { return event_.get(); }
  /// Makes the descriptor unreadable. Call it before looking at the ring, never after: what comes
  /// later makes it readable again.
  void clear();

 private:
  explicit WakeBridge(UniqueFd event) : event_(std::move(event)) {}
  UniqueFd event_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace handcast::ipc
