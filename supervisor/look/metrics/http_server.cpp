// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/metrics/http_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <list>
#include <system_error>
#include <thread>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {
namespace {

/// One client, from its connection to the end of its answer.
struct Connection {
  UniqueFd socket;
  std::int64_t until_ns = 0;  ///< it is closed then
  std::string request;        ///< what has arrived of it
  std::string answer;         ///< empty until the request is complete
  std::size_t sent = 0;       ///< bytes of the answer

  bool is_answered() const { return !answer.empty() && sent == answer.size(); }
  short events() const { return answer.empty() || is_answered() ? POLLIN : POLLOUT; }
};

std::string answer_with(std::string_view status, std::string_view type, std::string_view body,
                        bool with_body = true) {
  return fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: {}; charset=utf-8\r\nContent-Length: {}\r\n"
      "Connection: close\r\n\r\n{}",
      status, type, body.size(), with_body ? body : std::string_view());
}

std::string refusal(std::string_view status) {
  return answer_with(status, "text/plain", fmt::format("{}\n", status));
}

tl::unexpected<Error> cannot(std::string_view what) {
  return fail(Errc::unavailable, fmt::format("{}: {}", what, std::strerror(errno)));
}

Result<UniqueFd> listen_on(int port) {
  UniqueFd socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return cannot("a socket");
  // For an exporter that is started again while connections of the last one are closing.
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in address{.sin_family = AF_INET,
                            .sin_port = htons(static_cast<std::uint16_t>(port)),
                            .sin_addr = {htonl(INADDR_LOOPBACK)},
                            .sin_zero = {}};
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(socket.get(), HttpServer::kMostConnections) != 0)
    return cannot(fmt::format("port {} of 127.0.0.1", port));
  return socket;
}

}  // namespace

std::optional<HttpRequest> parse_http_request(std::string_view bytes) {
  if (bytes.find("\r\n\r\n") == bytes.npos && bytes.find("\n\n") == bytes.npos) return std::nullopt;
  auto line = bytes.substr(0, bytes.find_first_of("\r\n"));
  const auto first = line.find(' '), last = line.rfind(' ');
  if (first == line.npos || first == last || !line.substr(last + 1).starts_with("HTTP/1."))
    return HttpRequest{};
  const auto target = line.substr(first + 1, last - first - 1);
  return HttpRequest{line.substr(0, first), target.substr(0, target.find('?'))};
}

std::string http_answer(const HttpRequest& request, const std::function<std::string()>& text) {
  if (request.method.empty() || request.path.empty()) return refusal("400 Bad Request");
  const bool is_get = request.method == "GET";
  if (!is_get && request.method != "HEAD") return refusal("405 Method Not Allowed");
  if (request.path != "/metrics") return refusal("404 Not Found");
  return answer_with("200 OK", "text/plain; version=0.0.4", text(), is_get);
}

/// The thread and its connections. Only the thread uses them after the constructor.
class HttpServer::Loop {
 public:
  Loop(UniqueFd listener, UniqueFd stop, std::function<std::string()> text,
       std::int64_t patience_ns)
      : listener_(std::move(listener)),
        stop_(std::move(stop)),
        text_(std::move(text)),
        patience_ns_(patience_ns),
        thread_([this] { run(); }) {}
  ~Loop() {
    eventfd_write(stop_.get(), 1);
    thread_.join();
  }
  Loop(const Loop&) = delete;

  int port() const {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
  }

 private:
  void run() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, nullptr);  // signals are for the other threads
    std::vector<pollfd> events;
    for (;;) {
      events = {{stop_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}};
      for (const auto& connection : connections_)
        events.push_back({connection.socket.get(), connection.events(), 0});
      ::poll(events.data(), events.size(), wait_ms());
      if (events[0].revents != 0) return;
      auto event = events.begin() + 2;
      for (auto& connection : connections_)
        if ((event++)->revents != 0 && !serve(connection)) connection.until_ns = 0;
      const auto time_ns = now_ns();
      connections_.remove_if([&](const Connection& each) { return each.until_ns <= time_ns; });
      if (events[1].revents != 0) accept_one();
    }
  }

  /// Until the first connection is overdue; -1 if there is none.
  int wait_ms() const {
    if (connections_.empty()) return -1;
    const auto first = std::ranges::min_element(connections_, {}, &Connection::until_ns)->until_ns;
    return static_cast<int>(ns_to_ms(std::max<std::int64_t>(first - now_ns(), 0))) + 1;
  }

  void accept_one() {
    UniqueFd socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    const bool is_short_of_descriptors = !socket && (errno == EMFILE || errno == ENFILE);
    if (connections_.size() >= kMostConnections || is_short_of_descriptors) {
      if (!connections_.empty()) connections_.pop_front();  // the oldest
      if (connections_.empty()) sleep_until_ns(now_ns() + 10'000'000);
    }
    if (socket)
      connections_.push_back({.socket = std::move(socket), .until_ns = now_ns() + patience_ns_});
  }

  /// Reads or writes what is possible now. Returns false if the connection is done.
  bool serve(Connection& connection) {
    if (connection.answer.empty() && !read(connection)) return false;
    if (connection.answer.empty()) return true;
    if (connection.is_answered()) return read_rest(connection);
    return write(connection);
  }

  bool read(Connection& connection) {
    std::array<char, 4096> bytes;
    const auto count = ::recv(connection.socket.get(), bytes.data(), bytes.size(), 0);
    if (count <= 0) return count < 0 && (errno == EAGAIN || errno == EINTR);
    connection.request.append(bytes.data(), static_cast<std::size_t>(count));
    if (const auto request = parse_http_request(connection.request))
      connection.answer = http_answer(*request, text_);
    else if (connection.request.size() > kLongestRequest)
      connection.answer = refusal("431 Request Header Fields Too Large");
    if (!connection.answer.empty()) connection.until_ns = now_ns() + patience_ns_;
    return true;
  }

  bool write(Connection& connection) {
    const std::string_view rest = std::string_view(connection.answer).substr(connection.sent);
    const auto count = ::send(connection.socket.get(), rest.data(), rest.size(), MSG_NOSIGNAL);
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    connection.sent += static_cast<std::size_t>(count);
    if (connection.is_answered()) ::shutdown(connection.socket.get(), SHUT_WR);
    return true;
  }

  /// Waits for the client to close: if it were closed with unread bytes, the kernel would reset the
  /// connection, and the client could lose the answer.
  static bool read_rest(Connection& connection) {
    std::array<char, 4096> bytes;
    const auto count = ::recv(connection.socket.get(), bytes.data(), bytes.size(), 0);
    return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
  }

  UniqueFd listener_, stop_;
  std::function<std::string()> text_;
  std::int64_t patience_ns_;
  std::list<Connection> connections_;  ///< the oldest first
  std::thread thread_;
};

Result<HttpServer> HttpServer::listen(int port, std::function<std::string()> text,
                                      std::int64_t patience_ns) try {
  auto listener = listen_on(port);
  if (!listener) return tl::make_unexpected(listener.error());
  UniqueFd stop(eventfd(0, EFD_CLOEXEC));
  if (!stop) return cannot("an eventfd");
  return HttpServer(
      std::make_unique<Loop>(std::move(*listener), std::move(stop), std::move(text), patience_ns));
} catch (const std::system_error& error) {
  return fail(Errc::unavailable, fmt::format("no thread can be started: {}", error.what()));
}

int HttpServer::port() const { return loop_->port(); }

HttpServer::HttpServer(std::unique_ptr<Loop> loop) : loop_(std::move(loop)) {}
HttpServer::HttpServer(HttpServer&&) noexcept = default;
HttpServer::~HttpServer() = default;

}  // namespace handcast::supervisor
