// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <map>
#include <mutex>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "ipc/base/unique_fd.hpp"
#include "services/desk/lamp/md5.hpp"
#include "services/desk/lamp/pjlink.hpp"

namespace handcast::test {

/// A projector that speaks PJLink, or does it badly, on a port of this computer.
class PjlinkProjector {
 public:
  PjlinkProjector() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (::bind(socket_.get(), generic, size) != 0 || ::listen(socket_.get(), 8) != 0 ||
        ::getsockname(socket_.get(), generic, &size) != 0)
      throw std::runtime_error("no port for a projector");
    place.port = std::to_string(ntohs(address.sin_port));
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  /// Where it is; set a password to send one.
  desk::lamp::Place place{"127.0.0.1", "", ""};

  /// What it answers to a command without its value ("AVMT ?" and "AVMT 31" are "AVMT"), if not
  /// what its state says; and what it says first, if not a greeting. "": it says nothing; "close":
  /// it closes the connection.
  void answer(const std::string& command, const std::string& text) {
    const std::lock_guard lock(mutex_);
    answers_[command] = text;
  }
  void greet(const std::string& text) { answer("greeting", text); }
  /// Asks for a password.
  void lock(const std::string& password) {
    const std::lock_guard lock(mutex_);
    password_ = password;
  }
  void set(const std::string& command, const std::string& value) {
    const std::lock_guard lock(mutex_);
    state_[command] = value;
  }
  std::string state(const std::string& command) const {
    const std::lock_guard lock(mutex_);
    return state_.at(command);
  }
  /// The commands that it got, without what comes before the %.
  std::vector<std::string> commands() const {
    const std::lock_guard lock(mutex_);
    return commands_;
  }

 private:
  static constexpr const char* kSalt = "498e4a67";

  static bool await(int fd, const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd wait{fd, POLLIN, 0};
      if (::poll(&wait, 1, 10) > 0) return true;
    }
    return false;
  }
  static void say(const UniqueFd& peer, const std::string& text) {
    (void)::send(peer.get(), text.data(), text.size(), MSG_NOSIGNAL);
  }

  void run(const std::stop_token& stop) {
    while (await(socket_.get(), stop)) {
      const UniqueFd peer(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (peer) serve(peer, stop);
    }
  }

  void serve(const UniqueFd& peer, const std::stop_token& stop) {
    auto greeting = said("greeting");
    if (!greeting)
      greeting = password().empty() ? "PJLINK 0\r" : std::string("PJLINK 1 ") + kSalt + "\r";
    if (*greeting == "close") return;
    say(peer, *greeting);
    std::string left;
    bool is_first = true;
    while (await(peer.get(), stop)) {
      char bytes[256];
      const auto got = ::recv(peer.get(), bytes, sizeof bytes, 0);
      if (got <= 0) return;
      left.append(bytes, static_cast<std::size_t>(got));
      for (auto end = left.find('\r'); end != left.npos; end = left.find('\r')) {
        const auto reply = obey(left.substr(0, end), std::exchange(is_first, false));
        left.erase(0, end + 1);
        if (reply == "close") return;
        say(peer, reply);
      }
    }
  }

  std::string obey(const std::string& line, bool is_first) {
    const std::lock_guard lock(mutex_);
    const auto percent = line.find('%');
    if (is_first && !password_.empty() &&
        line.substr(0, percent) != desk::lamp::md5(kSalt + password_))
      return "PJLINK ERRA\r";
    const auto command = line.substr(percent);
    commands_.push_back(command);
    const auto name = command.substr(2, 4), value = command.substr(7);
    if (const auto found = answers_.find(name); found != answers_.end()) return found->second;
    if (!state_.contains(name)) return "%1" + name + "=ERR1\r";
    if (value == "?") return "%1" + name + "=" + state_[name] + "\r";
    state_[name] = value == "30" ? "30" : value;
    return "%1" + name + "=OK\r";
  }

  std::optional<std::string> said(const std::string& what) const {
    const std::lock_guard lock(mutex_);
    const auto found = answers_.find(what);
    return found == answers_.end() ? std::nullopt : std::optional(found->second);
  }
  std::string password() const {
    const std::lock_guard lock(mutex_);
    return password_;
  }

  UniqueFd socket_;
  mutable std::mutex mutex_;
  std::map<std::string, std::string> state_{{"POWR", "0"},      {"AVMT", "30"},
                                            {"INPT", "11"},     {"ERST", "000000"},
                                            {"LAMP", "1234 0"}, {"NAME", "Theatre left"}};
  std::map<std::string, std::string> answers_;
  std::string password_;
  std::vector<std::string> commands_;
  std::jthread thread_;
};

}  // namespace handcast::test
