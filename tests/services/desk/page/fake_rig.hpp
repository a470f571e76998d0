// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ipc/control/control_message.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::test {

/// Listens in the place of a rig's supervisor: says a status, gives rings, and says that all else
/// is done.
class FakeRig {
 public:
  explicit FakeRig(const std::string& name, nlohmann::json status = nlohmann::json::object())
      : status_(std::move(status)) {
    const auto address = control::address_of(name).value();
    ::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address.socket), address.size);
    ::listen(listener_.get(), 64);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  }

  void say(nlohmann::json status) {
    const std::lock_guard lock(mutex_);
    status_ = std::move(status);
  }
  /// Gives a ring to those that ask. The segment must live as long as this.
  void give(const std::string& stream, int fd) {
    const std::lock_guard lock(mutex_);
    rings_[stream] = fd;
  }
  /// What was asked for, but status and rings.
  std::vector<std::string> asked() const {
    const std::lock_guard lock(mutex_);
    return asked_;
  }

 private:
  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd waiting{listener_.get(), POLLIN, 0};
      if (::poll(&waiting, 1, 10) != 1) continue;
      const UniqueFd client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      pollfd asked{client.get(), POLLIN, 0};
      if (::poll(&asked, 1, 1000) != 1) continue;
      std::array<char, 4096> bytes;
      const auto count = ::read(client.get(), bytes.data(), bytes.size());
      if (count > 0) answer(client.get(), {bytes.data(), static_cast<std::size_t>(count)});
    }
  }

  void answer(int client, std::string line) {
    line.erase(line.find_last_not_of('\n') + 1);
    const auto request = control::parse_request(line);
    const std::lock_guard lock(mutex_);
    auto answer = control::success();
    std::vector<UniqueFd> owned;
    if (!request)
      answer = control::failure(request.error().what);
    else if (request->verb == control::Verb::status)
      answer["status"] = status_;
    else if (request->verb == control::Verb::rings)
      owned = open_rings(answer["rings"] = nlohmann::json::array());
    else
      asked_.push_back(line);
    send(client, control::to_line(answer) + "\n", owned);
  }

  std::vector<UniqueFd> open_rings(nlohmann::json& names) {
    std::vector<UniqueFd> owned;
    for (const auto& [stream, fd] : rings_) {
      names.push_back(stream);
      const auto path = "/proc/self/fd/" + std::to_string(fd);
      owned.emplace_back(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    }
    return owned;
  }

  static void send(int client, const std::string& line, const std::vector<UniqueFd>& owned) {
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(16 * sizeof(int))> room{};
    iovec text{const_cast<char*>(line.data()), line.size()};
    msghdr message{};
    message.msg_iov = &text;
    message.msg_iovlen = 1;
    if (!owned.empty()) {
      message.msg_control = room.data();
      message.msg_controllen = CMSG_SPACE(owned.size() * sizeof(int));
      auto* part = CMSG_FIRSTHDR(&message);
      part->cmsg_level = SOL_SOCKET;
      part->cmsg_type = SCM_RIGHTS;
      part->cmsg_len = CMSG_LEN(owned.size() * sizeof(int));
      for (std::size_t i = 0; i < owned.size(); ++i) {
        const int fd = owned[i].get();
        std::memcpy(CMSG_DATA(part) + i * sizeof fd, &fd, sizeof fd);
      }
    }
    ::sendmsg(client, &message, MSG_NOSIGNAL);
  }

  mutable std::mutex mutex_;
  nlohmann::json status_;
  std::map<std::string, int> rings_;
  std::vector<std::string> asked_;
  UniqueFd listener_{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  std::jthread thread_;
};

}  // namespace handcast::test
