// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <string>
#include <thread>

#include "ipc/control/rig_address.hpp"

namespace handcast::control {

/// Listens in the place of the rig "desk" and answers every request with the same bytes, whatever
/// was asked. It then closes the connection, or keeps it open without another word.
class ListeningRig {
 public:
  enum class Then { close, keep };

  explicit ListeningRig(std::string answer, Then then = Then::close)
      : answer_(std::move(answer)), then_(then) {
    const auto address = address_of("desk").value();
    ::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address.socket), address.size);
    ::listen(listener_.get(), 16);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  }

 private:
  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd waiting{listener_.get(), POLLIN, 0};
      if (::poll(&waiting, 1, 10) != 1) continue;
      UniqueFd client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      pollfd asked{client.get(), POLLIN, 0};
      if (::poll(&asked, 1, 1000) != 1) continue;
      std::array<char, 4096> request;
      if (::read(client.get(), request.data(), request.size()) <= 0) continue;  // it only looked
      for (std::size_t sent = 0; sent < answer_.size();) {
        const auto count =
            ::send(client.get(), answer_.data() + sent, answer_.size() - sent, MSG_NOSIGNAL);
        if (count <= 0) break;
        sent += static_cast<std::size_t>(count);
      }
      if (then_ == Then::keep) kept_ = std::move(client);
    }
  }

  std::string answer_;
  Then then_;
  UniqueFd listener_{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  UniqueFd kept_;
  std::jthread thread_;
};

}  // namespace handcast::control
