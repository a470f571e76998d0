// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/systemd.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <optional>

namespace handcast::supervisor {
namespace {

constexpr int kFirstPassedFd = 3;  // SD_LISTEN_FDS_START
constexpr int kMostPassedFds = 1024;

template <class Number>
std::optional<Number> number_from(const char* variable) {
  const char* value = std::getenv(variable);
  const std::string_view text = value ? value : "";
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

struct Address {
  sockaddr_un socket{};
  socklen_t size = 0;
};

/// $NOTIFY_SOCKET: a path, or @NAME in the abstract namespace.
std::optional<Address> address_of_systemd() {
  const char* value = std::getenv("NOTIFY_SOCKET");
  const std::string_view path = value ? value : "";
  Address address;
  if (path.size() < 2 || (path[0] != '/' && path[0] != '@') ||
      path.size() >= sizeof address.socket.sun_path)
    return std::nullopt;
  address.socket.sun_family = AF_UNIX;
  std::memcpy(address.socket.sun_path, path.data(), path.size());
  if (path[0] == '@') address.socket.sun_path[0] = '\0';
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size() +
                                        (path[0] == '@' ? 0 : 1));
  return address;
}

/// Sends one datagram, with a descriptor or without (-1). If systemd's queue is full, waits for
/// kSendPatience at most, because the rig waits, too.
void send_to_systemd(std::string_view state, int fd) {
  auto address = address_of_systemd();
  const UniqueFd socket(address ? ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0) : -1);
  if (!socket) return;
  constexpr timeval kSendPatience{.tv_sec = 0, .tv_usec = 200'000};
  setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &kSendPatience, sizeof kSendPatience);

  iovec text{.iov_base = const_cast<char*>(state.data()), .iov_len = state.size()};
  msghdr message{};
  message.msg_name = &address->socket;
  message.msg_namelen = address->size;
  message.msg_iov = &text;
  message.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  if (fd >= 0) {
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    auto* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof fd);
    std::memcpy(CMSG_DATA(header), &fd, sizeof fd);
  }
  sendmsg(socket.get(), &message, MSG_NOSIGNAL);
}

/// The names in $LISTEN_FDNAMES ("camera.frames:pose.hands"), one for each of `count` descriptors.
std::vector<std::string> passed_names(int count) {
  const char* value = std::getenv("LISTEN_FDNAMES");
  std::string_view text = value ? value : "";
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    const auto colon = text.find(':');
    names.emplace_back(text.substr(0, colon));
    text = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  }
  return names;
}

}  // namespace

void notify_systemd(std::string_view state) { send_to_systemd(state, -1); }

// systemd stores every open file, even a second one of the same memory. So the stored file of this
// name is removed first.
void store_with_systemd(const std::vector<std::pair<std::string, int>>& rings) {
  for (const auto& [stream, fd] : rings) {
    notify_systemd(fmt::format("FDSTOREREMOVE=1\nFDNAME={}", stream));
    send_to_systemd(fmt::format("FDSTORE=1\nFDNAME={}", stream), fd);
  }
}

std::vector<std::pair<std::string, UniqueFd>> taken_from_systemd() {
  const bool for_us = number_from<pid_t>("LISTEN_PID") == getpid();
  const int count = number_from<int>("LISTEN_FDS").value_or(0);
  std::vector<std::pair<std::string, UniqueFd>> taken;
  if (for_us && count > 0 && count <= kMostPassedFds) {
    auto names = passed_names(count);
    for (int i = 0; i < count; ++i) {
      UniqueFd fd(kFirstPassedFd + i);
      if (fcntl(fd.get(), F_SETFD, FD_CLOEXEC) == 0)
        taken.emplace_back(std::move(names[static_cast<std::size_t>(i)]), std::move(fd));
      else
        fd.release();  // not an open descriptor
    }
  }
  for (const char* variable : {"LISTEN_PID", "LISTEN_FDS", "LISTEN_FDNAMES"}) unsetenv(variable);
  return taken;
}

std::optional<std::int64_t> watchdog_period_ns() {
  const auto for_whom = number_from<pid_t>("WATCHDOG_PID");
  const auto limit_us = number_from<std::int64_t>("WATCHDOG_USEC");
  if (!limit_us || *limit_us <= 0 || (for_whom && *for_whom != getpid())) return std::nullopt;
  return *limit_us * 1000 / 2;
}

Watchdog::Watchdog() : period_ns_(watchdog_period_ns()) {}

void Watchdog::tick(std::int64_t now_ns) {
  if (!period_ns_ || now_ns < next_ns_) return;
  next_ns_ = now_ns + *period_ns_;
  notify_systemd("WATCHDOG=1");
}

}  // namespace handcast::supervisor
