// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::test {

/// A connection to a port of this computer that sends any bytes, also none that a browser would.
class Wire {
 public:
  explicit Wire(std::uint16_t port) : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_open_ =
        ::connect(fd_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }

  bool is_open() const { return is_open_; }
  int fd() const { return fd_.get(); }
  /// False: the other end has closed.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const auto count = ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  /// Receives until the other end closes, `text` has come, or the time is over.
  const std::string& receive(std::string_view text = "", std::size_t from = 0,
                             std::chrono::nanoseconds patience = std::chrono::seconds(20)) {
    const auto until = Deadline::in(patience);
    while (!until.passed() && (text.empty() || received_.find(text, from) == std::string::npos)) {
      pollfd readable{fd_.get(), POLLIN, 0};
      if (::poll(&readable, 1, 20) <= 0) continue;
      std::array<char, 1 << 14> bytes;
      const auto count = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
      if (count <= 0) {
        is_closed_ = true;
        break;
      }
      received_.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return received_;
  }
  /// True if the other end was seen to close the connection.
  bool is_closed() const { return is_closed_; }

 private:
  UniqueFd fd_;
  bool is_open_ = false, is_closed_ = false;
  std::string received_;
};

/// What came back.
struct Answer {
  int status = 0;  ///< 0: nothing
  std::string head, body;
};

inline Answer parse_answer(const std::string& text) {
  Answer answer;
  const auto end = text.find("\r\n\r\n");
  if (!text.starts_with("HTTP/1.1 ") || end == std::string::npos) return answer;
  answer.status = std::atoi(text.c_str() + 9);
  answer.head = text.substr(0, end);
  answer.body = text.substr(end + 4);
  return answer;
}

using HttpHeaders = std::vector<std::pair<std::string, std::string>>;

/// A request as a browser writes it.
inline std::string request_text(std::uint16_t port, std::string_view method, std::string_view path,
                                const HttpHeaders& headers, std::string_view body = "") {
  auto text = fmt::format("{} {} HTTP/1.1\r\n", method, path);
  bool has_host = false;
  for (const auto& [name, value] : headers) {
    text += fmt::format("{}: {}\r\n", name, value);
    has_host |= name == "Host";
  }
  if (!has_host) text += fmt::format("Host: 127.0.0.1:{}\r\n", port);
  if (method == "POST")
    text += fmt::format("Content-Type: application/json\r\nContent-Length: {}\r\n", body.size());
  return text + "\r\n" + std::string(body);
}

inline Answer ask(std::uint16_t port, std::string_view method, std::string_view path,
                  const HttpHeaders& headers = {}, std::string_view body = "") {
  Wire wire(port);
  wire.send(request_text(port, method, path, headers, body));
  return parse_answer(wire.receive());
}

/// The same of one that is turned away at first because there were so many before: it asks again,
/// as the page does, for 10 s.
inline Answer ask_again(std::uint16_t port, std::string_view method, std::string_view path) {
  Answer answer;
  for (int i = 0; i < 1000 && answer.status == 0; ++i) {
    if (i > 0) sleep_until_ns(now_ns() + 10'000'000);
    answer = ask(port, method, path);
  }
  return answer;
}

}  // namespace handcast::test
