// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// Calls back when descriptors become readable. One thread; callbacks may watch and forget, also
/// themselves. A callback may be called once too often (its descriptor's number was reused in the
/// same turn): it must not block on an empty descriptor.
class EventLoop {
 public:
  static Result<EventLoop> open();

  void watch(int fd, std::function<void()> on_readable);
  /// Calls back also while `fd`, which is watched, can be written to. An empty function: no more.
  void watch_writing(int fd, std::function<void()> on_writable);
  void forget(int fd);
  /// Waits for events and handles them.
  void turn();

 private:
  explicit EventLoop(UniqueFd epoll) : epoll_(std::move(epoll)) {}
  UniqueFd epoll_;
  struct Handlers {
    std::function<void()> readable, writable;
  };
  void call(int fd, std::function<void()> Handlers::*which);
  std::map<int, Handlers> handlers_;
};

/// A descriptor that is readable every `period_ns`. Read it to wait for the next time.
Result<UniqueFd> open_timer(std::int64_t period_ns);
/// Blocks the signals that stop the rig (SIGINT, SIGTERM, SIGHUP) and makes them readable.
Result<UniqueFd> open_stop_signals();
/// Reads what is there and forgets it.
void drain(int fd);

}  // namespace handcast::supervisor
