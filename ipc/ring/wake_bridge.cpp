// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/wake_bridge.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace handcast::ipc {
namespace {

/// Blocks all signals while the thread is started. The thread inherits the mask, so signals are
/// delivered to the threads of the program.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

}  // namespace

Result<std::unique_ptr<WakeBridge>> WakeBridge::start(std::function<bool()> wait) {
  UniqueFd event(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!event)
    return fail(Errc::unavailable,
                fmt::format("no eventfd can be created: {}", std::strerror(errno)));
  std::unique_ptr<WakeBridge> bridge(new WakeBridge(std::move(event)));
  const auto run = [bridge = bridge.get(), wait = std::move(wait)] {
    while (!bridge->stop_.load(std::memory_order_relaxed))
      if (wait()) ::eventfd_write(bridge->fd(), 1);
  };
  try {
    const SignalsBlocked blocked;
    bridge->thread_ = std::thread(run);
  } catch (const std::system_error& error) {
    return fail(Errc::unavailable, fmt::format("no thread can be started: {}", error.what()));
  }
  return bridge;
}

WakeBridge::~WakeBridge() {
  stop_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
}

void WakeBridge::clear() {
  eventfd_t count = 0;
  ::eventfd_read(event_.get(), &count);  // EAGAIN: it was not readable
}

}  // namespace handcast::ipc
