// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/keeper_link.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <string_view>

namespace handcast::supervisor {
namespace {

/// The keeper also reports grandchildren; their reports are never taken.
constexpr std::size_t kMostRemembered = 1024;

/// The number in an environment variable, -1 if there is none. Unsets the variable, because
/// services must not inherit it.
int take_number(const char* variable) {
  const char* value = std::getenv(variable);
  const std::string_view text = value ? value : "";
  int number = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  unsetenv(variable);
  return whole ? number : -1;
}

bool is_report_socket(int fd) {
  int type = 0;
  socklen_t size = sizeof type;
  return fd > STDERR_FILENO && getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) == 0 &&
         type == SOCK_SEQPACKET;
}

Exit exit_of(int code, int status) { return {.signalled = code != CLD_EXITED, .code = status}; }

/// The struct of PIDFD_GET_INFO (linux/pidfd.h), which older headers lack.
struct PidfdInfo {
  std::uint64_t mask, cgroup;
  std::uint32_t pid, tgid, ppid, ruid, rgid, euid, egid, suid, sgid, fsuid, fsgid;
  std::int32_t exit_code;
};
static_assert(sizeof(PidfdInfo) == 64);
constexpr std::uint64_t kPidfdInfoExit = 1 << 3;
constexpr unsigned long kPidfdGetInfo = _IOC(_IOC_READ | _IOC_WRITE, 0xFF, 11, sizeof(PidfdInfo));

}  // namespace

KeeperLink KeeperLink::from_environment() {
  KeeperLink link;
  const int fd = take_number(kKeeperVariable);
  if (!is_report_socket(fd)) return link;
  fcntl(fd, F_SETFD, FD_CLOEXEC);
  link.socket_ = UniqueFd(fd);
  link.had_keeper_ = true;
  return link;
}

void KeeperLink::read() {
  ExitReport report;
  ssize_t size = 0;
  while (socket_ && (size = recv(socket_.get(), &report, sizeof report, MSG_DONTWAIT)) > 0) {
    if (size != static_cast<ssize_t>(sizeof report)) continue;
    if (exits_.size() >= kMostRemembered) exits_.clear();
    exits_.insert_or_assign(report.pid, exit_of(report.code, report.status));
  }
  if (size == 0) socket_.reset();  // the keeper has ended
}

void KeeperLink::beat(std::string_view rig, bool stopping) {
  Beat beat{.stopping = stopping};
  rig.copy(beat.rig.data(), beat.rig.size() - 1);
  send(socket_.get(), &beat, sizeof beat, MSG_DONTWAIT | MSG_NOSIGNAL);
}

std::optional<Exit> KeeperLink::take(pid_t pid) {
  const auto exit = exits_.extract(pid);
  return exit ? std::optional(exit.mapped()) : std::nullopt;
}

std::optional<Exit> exit_told_by_kernel(int pidfd) {
  PidfdInfo info{.mask = kPidfdInfoExit};
  if (ioctl(pidfd, kPidfdGetInfo, &info) != 0 || (info.mask & kPidfdInfoExit) == 0)
    return std::nullopt;
  if (WIFEXITED(info.exit_code))
    return Exit{.signalled = false, .code = WEXITSTATUS(info.exit_code)};
  return Exit{.signalled = true, .code = WTERMSIG(info.exit_code)};
}

}  // namespace handcast::supervisor
