// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// Calls functions when descriptors become readable or writable. One thread. A callback may watch
/// and forget descriptors, its own included. It may be called once too often, if the number of its
/// descriptor was reused in the same turn: it must not block on an empty descriptor.
class EventLoop {
 public:
  /// Errors: unavailable.
  static Result<EventLoop> open();

  /// Calls back while `fd` is readable.
  void watch(int fd, std::function<void()> on_readable);
  /// Also calls back while `fd`, which is watched, is writable. An empty function ends that.
  void watch_writing(int fd, std::function<void()> on_writable);
  /// Ends all callbacks for `fd`. Does nothing if it is not watched.
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

/// A descriptor that becomes readable every `period_ns`, until it is read. Errors: unavailable.
Result<UniqueFd> open_timer(std::int64_t period_ns);
/// Blocks the signals that stop a rig (SIGINT, SIGTERM, SIGHUP). The descriptor is readable when
/// one has arrived. Errors: unavailable.
Result<UniqueFd> open_stop_signals();
/// Reads a non-blocking descriptor until it is empty.
void drain(int fd);

}  // namespace handcast::supervisor
