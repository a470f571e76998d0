// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/query_server.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace handcast::desk::osc {
namespace {

constexpr std::size_t kMostConnections = 16;
constexpr std::size_t kMostRequest = 4096;
constexpr std::int64_t kPatience_ns = 2'000'000'000;
constexpr std::int64_t kAnswerPause_ns = 20'000'000;
constexpr std::string_view kEnd = "\r\n\r\n";

std::string write_answer(std::string_view status, std::string_view body) {
  return fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\n"
      "Cache-Control: no-store\r\nConnection: close\r\n\r\n{}",
      status, body.size(), body);
}

}  // namespace

void QueryServer::add_to(std::vector<pollfd>& waits) const {
  if (socket_) waits.push_back({socket_.get(), POLLIN, 0});
  for (const auto& connection : connections_)
    waits.push_back({connection.socket.get(),
                     static_cast<short>(connection.answer.empty() ? POLLIN : POLLOUT), 0});
}

bool QueryServer::turn(std::int64_t now_ns) {
  if (socket_) accept(now_ns);
  std::erase_if(connections_, [&](auto& connection) {
    return now_ns >= connection.until_ns || !go_on(connection, now_ns);
  });
  return std::ranges::any_of(connections_, &Connection::is_waiting);
}

void QueryServer::accept(std::int64_t now_ns) {
  for (std::size_t i = 0; i < kMostConnections; ++i) {
    UniqueFd taken(::accept4(socket_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!taken) return;
    if (connections_.size() < kMostConnections)
      connections_.push_back({std::move(taken), now_ns + kPatience_ns, "", "", 0, false});
  }
}

/// False: the connection is over.
bool QueryServer::go_on(Connection& connection, std::int64_t now_ns) {
  const int socket = connection.socket.get();
  if (connection.answer.empty()) {
    std::array<char, kMostRequest> bytes;
    const auto count = ::recv(socket, bytes.data(), bytes.size(), 0);
    if (count == 0 || (count < 0 && errno != EAGAIN)) return false;
    if (count > 0) connection.request.append(bytes.data(), static_cast<std::size_t>(count));
    connection.is_waiting = connection.request.find(kEnd) != std::string::npos;
    if (connection.request.size() > kMostRequest)
      connection.answer = write_answer("431 Request Header Fields Too Large", "");
    else if (!connection.is_waiting || now_ns < next_answer_ns_)
      return true;
    else
      connection.answer = answer_to(connection.request);
    connection.is_waiting = false;
    next_answer_ns_ = now_ns + kAnswerPause_ns;
  }
  const std::string_view rest = std::string_view(connection.answer).substr(connection.sent);
  const auto count = ::send(socket, rest.data(), rest.size(), MSG_NOSIGNAL);
  if (count < 0) return errno == EAGAIN;
  connection.sent += static_cast<std::size_t>(count);
  return connection.sent < connection.answer.size();
}

std::string QueryServer::answer_to(std::string_view request) const {
  constexpr std::string_view kGet = "GET ";
  if (!request.starts_with(kGet)) return write_answer("405 Method Not Allowed", "");
  const auto query =
      request.substr(kGet.size(), request.find_first_of(" \r", kGet.size()) - kGet.size());
  const auto body = answer_(query);
  if (!body) return write_answer("404 Not Found", "");
  return body->empty() ? write_answer("204 No Content", "") : write_answer("200 OK", *body);
}

}  // namespace handcast::desk::osc
