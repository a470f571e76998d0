// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/stop_signal.hpp"

#include <signal.h>

#include <atomic>

#include "ipc/base/inherited.hpp"

namespace handcast::daemon {
namespace {

std::atomic<Stop> stop{Stop::none};
static_assert(std::atomic<Stop>::is_always_lock_free, "written in a signal handler");

void note(int number) {
  auto before = Stop::none;
  const auto wanted = number == SIGINT ? Stop::for_good : Stop::at_once;
  if (!stop.compare_exchange_strong(before, wanted, std::memory_order_relaxed))
    stop.store(Stop::at_once, std::memory_order_relaxed);
}

}  // namespace

void install_stop_signals() {
  struct sigaction action {};
  action.sa_handler = note;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGTERM, SIGINT})
    if (!inherited::is_ignored(number)) sigaction(number, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
}

Stop requested_stop() { return stop.load(std::memory_order_relaxed); }

}  // namespace handcast::daemon
