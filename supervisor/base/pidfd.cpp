// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/pidfd.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

namespace handcast::supervisor {
namespace {

bool ends_within_ms(const UniqueFd& pidfd, int span_ms) {
  pollfd ended{.fd = pidfd.get(), .events = POLLIN, .revents = 0};
  return poll(&ended, 1, span_ms) == 1;
}

}  // namespace

UniqueFd open_pidfd(pid_t pid) {
  return UniqueFd(static_cast<int>(syscall(SYS_pidfd_open, pid, 0)));
}

void send_signal(const UniqueFd& pidfd, int number) {
  syscall(SYS_pidfd_send_signal, pidfd.get(), number, nullptr, 0);
}

bool has_ended(const UniqueFd& pidfd) { return ends_within_ms(pidfd, 0); }

bool ends_within(const UniqueFd& pidfd, double seconds) {
  return ends_within_ms(pidfd, static_cast<int>(std::max(seconds, 0.0) * 1e3) + 1);
}

void kill_now(pid_t pid, const UniqueFd& pidfd) {
  if (has_ended(pidfd)) return;
  kill(-pid, SIGKILL);  // it lives, so its pid has not been reused
  send_signal(pidfd, SIGKILL);
  ends_within(pidfd, 1);
}

}  // namespace handcast::supervisor
