// SPDX-License-Identifier: Apache-2.0
#include "services/desk/lamp/connection.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

namespace handcast::desk::lamp {
namespace {

constexpr std::size_t kLongestLine = 256;      ///< PJLink has 136
constexpr std::int64_t kLook_ns = 50'000'000;  ///< at a stop

}  // namespace

Connection::Connection(UniqueFd socket, std::string name, Deadline deadline, std::stop_token stop)
    : socket_(std::move(socket)),
      name_(std::move(name)),
      deadline_(deadline),
      stop_(std::move(stop)) {}

Result<void> Connection::await(short events) const {
  for (;;) {
    const std::int64_t left_ns = deadline_.time_ns() - now_ns();
    if (left_ns <= 0 || stop_.stop_requested())
      return fail(Errc::timeout, fmt::format("{} did not answer in time", name_));
    pollfd wait{socket_.get(), events, 0};
    const auto wait_ms = (std::min(left_ns, kLook_ns) + 999'999) / 1'000'000;
    if (::poll(&wait, 1, static_cast<int>(wait_ms)) > 0) return {};
  }
}

Result<Connection> Connection::open(const std::string& host, const std::string& port,
                                    Deadline deadline, std::stop_token stop) {
  const auto name = fmt::format("the projector at {}:{}", host, port);
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  if (const int error = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found))
    return fail(error == EAI_AGAIN ? Errc::unavailable : Errc::bad_config,
                fmt::format("{} is not known ({}); check projector.lamp.pjlink", name,
                            ::gai_strerror(error)));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  UniqueFd socket(::socket(found->ai_family, found->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const auto refused = [&](int error) {
    return fail(Errc::unavailable,
                fmt::format("{} does not take a connection ({}); is it on the network, and PJLink "
                            "turned on in its menu?",
                            name, ::strerror(error)));
  };
  if (!socket) return refused(errno);
  const int begun = ::connect(socket.get(), found->ai_addr, found->ai_addrlen);
  if (begun != 0 && errno != EINPROGRESS) return refused(errno);
  Connection connection(std::move(socket), name, deadline, std::move(stop));
  if (const auto ready = connection.await(POLLOUT); !ready)
    return tl::make_unexpected(ready.error());
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(connection.socket_.get(), SOL_SOCKET, SO_ERROR, &error, &size);
  if (error != 0) return refused(error);
  return connection;
}

Result<void> Connection::write(std::string_view line) {
  std::string bytes(line);
  bytes += '\r';
  for (std::string_view left = bytes; !left.empty();) {
    if (auto ready = await(POLLOUT); !ready) return ready;
    const auto sent = ::send(socket_.get(), left.data(), left.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno != EAGAIN && errno != EINTR)
      return fail(Errc::disconnected, fmt::format("{} closed the connection", name_));
    left.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(sent, 0)));
  }
  return {};
}

Result<std::string> Connection::read() {
  for (;;) {
    if (const auto end = left_.find('\r'); end != left_.npos) {
      auto line = left_.substr(0, end);
      left_.erase(0, end + 1);
      return line;
    }
    if (left_.size() > kLongestLine)
      return fail(Errc::bad_data,
                  fmt::format("{} does not speak PJLink: its line does not end", name_));
    if (const auto ready = await(POLLIN); !ready) return tl::make_unexpected(ready.error());
    char bytes[kLongestLine];
    const auto got = ::recv(socket_.get(), bytes, sizeof bytes, 0);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR))
      return fail(Errc::disconnected, fmt::format("{} closed the connection", name_));
    left_.append(bytes, static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  }
}

}  // namespace handcast::desk::lamp
