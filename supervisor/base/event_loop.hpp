// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// Calls functions when descriptors become readable or writable. One thread. A callback may call
/// watch() and forget() for any descriptor, also its own. It must not block if its descriptor is
/// not ready: if the number of a descriptor is reused within one turn, the new callback may be
/// called for an event of the old one.
class EventLoop {
 public:
  /// Errors: unavailable.
  static Result<EventLoop> open();

  /// Calls `on_readable` at each turn in which `fd` is readable.
  void watch(int fd, std::function<void()> on_readable);
  /// Calls `on_writable` at each turn in which `fd` is writable; an empty function ends this. `fd`
  /// must be watched by watch().
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

/// A timer: its descriptor becomes readable every `period_ns`, until it is read. Errors:
/// unavailable.
Result<UniqueFd> open_timer(std::int64_t period_ns);
/// Blocks the signals that stop a rig (SIGINT, SIGTERM and SIGHUP, but not those that the caller
/// wants to be ignored) and opens a descriptor that is readable when one has arrived. Errors:
/// unavailable.
Result<UniqueFd> open_stop_signals();
/// Reads a non-blocking descriptor until it is empty.
void drain(int fd);

}  // namespace handcast::supervisor
