// SPDX-License-Identifier: Apache-2.0
#include "supervisor/control/control_server.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "ipc/control/rig_address.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::size_t kLongestRequest = 1 << 16;
constexpr std::size_t kMostUnsent = 1 << 22;
constexpr std::size_t kMostClients = 64;

Result<UniqueFd> claim(const control::RigAddress& address, const std::string& rig) {
  UniqueFd listener(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto* where = reinterpret_cast<const sockaddr*>(&address.socket);
  if (listener && bind(listener.get(), where, address.size) == 0 &&
      ::listen(listener.get(), SOMAXCONN) == 0)
    return listener;
  if (!listener || errno != EADDRINUSE)
    return fail(Errc::unavailable,
                fmt::format("control socket {}: {}", address.text, std::strerror(errno)));
  const auto other = control::connect_to(address);
  if (!other && other.error().code == Errc::bad_config) return tl::make_unexpected(other.error());
  return fail(
      Errc::unavailable,
      fmt::format("a rig named '{}' is up already; `handcast down --rig {}` stops it", rig, rig));
}

std::vector<std::string> take_lines(std::string& text) {
  std::vector<std::string> lines;
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    lines.push_back(text.substr(0, end));
    text.erase(0, end + 1);
  }
  return lines;
}

}  // namespace

Result<std::unique_ptr<ControlServer>> ControlServer::listen(const std::string& rig,
                                                             EventLoop& loop,
                                                             OnRequest on_request) {
  const auto address = control::address_of(rig);
  if (!address) return tl::make_unexpected(address.error());
  auto listener = claim(*address, rig);
  if (!listener) return tl::make_unexpected(listener.error());
  return std::unique_ptr<ControlServer>(
      new ControlServer(std::move(*listener), loop, std::move(on_request)));
}

ControlServer::ControlServer(UniqueFd listener, EventLoop& loop, OnRequest on_request)
    : listener_(std::move(listener)), loop_(loop), on_request_(std::move(on_request)) {
  loop_.watch(listener_.get(), [this] { accept(); });
}

void ControlServer::stop_accepting() {
  if (!listener_) return;
  loop_.forget(listener_.get());
  listener_.reset();
}

ControlServer::~ControlServer() {
  stop_accepting();
  for (const auto& [id, client] : clients_) loop_.forget(client.socket.get());
}

void ControlServer::accept() {
  UniqueFd socket(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!socket || !control::is_of_this_user(socket.get())) return;
  make_room();
  const auto id = next_id_++;
  loop_.watch(socket.get(), [this, id] { read(id); });
  clients_.emplace(id, Client{std::move(socket), {}, {}});
}

/// Drops a client if there are kMostClients: the oldest that waits for no answer, or else the
/// oldest.
void ControlServer::make_room() {
  if (clients_.size() < kMostClients) return;
  const auto idle =
      std::ranges::find_if(clients_, [](const auto& client) { return client.second.is_idle(); });
  drop(idle == clients_.end() ? clients_.begin()->first : idle->first);
}

void ControlServer::read(std::uint64_t id) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  auto& client = found->second;
  std::array<char, 4096> bytes;
  const auto count = ::read(client.socket.get(), bytes.data(), bytes.size());
  if (count < 0 && errno == EAGAIN) return;
  if (count > 0) client.unread.append(bytes.data(), static_cast<std::size_t>(count));
  if (count <= 0 || client.unread.size() > kLongestRequest) return drop(id);

  for (const auto& line : take_lines(client.unread))
    if (clients_.contains(id)) answer_line(id, line);  // it may be dropped after the first
}

void ControlServer::answer_line(std::uint64_t id, const std::string& line) {
  ++clients_.at(id).unanswered;
  const auto request = control::parse_request(line);
  if (!request) return send(id, control::failure(request.error().what));
  on_request_(*request,
              Reply([this, id](const nlohmann::json& answer, const std::vector<int>& descriptors) {
                send(id, answer, descriptors);
              }));
}

// A larger socket buffer would not replace `unsent`: the kernel's limit (net.core.wmem_max) is
// below the size of a status with the last lines of every service. Descriptors are sent at once or
// not at all: none is kept for a slow client.
void ControlServer::send(std::uint64_t id, const nlohmann::json& answer,
                         const std::vector<int>& descriptors) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  auto& client = found->second;
  --client.unanswered;
  const bool is_slow = !client.unsent.empty();
  if (is_slow && !descriptors.empty()) return drop(id);
  client.unsent += control::to_line(answer) + "\n";
  if (!is_slow && !send_some(client, descriptors)) return drop(id);
  if (client.unsent.size() > kMostUnsent) return drop(id);
  if (!is_slow && !client.unsent.empty())
    loop_.watch_writing(client.socket.get(), [this, id] { send_rest(id); });
}

/// Sends as much as fits into the socket's buffer. False: the client is gone, or these descriptors
/// cannot be sent.
bool ControlServer::send_some(Client& client, const std::vector<int>& descriptors) {
  if (descriptors.size() > control::kMostDescriptors) return false;
  iovec text{.iov_base = client.unsent.data(), .iov_len = client.unsent.size()};
  msghdr message{};
  message.msg_iov = &text;
  message.msg_iovlen = 1;
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(control::kMostDescriptors * sizeof(int))>
      room{};
  if (!descriptors.empty()) {
    const auto size = descriptors.size() * sizeof(int);
    message.msg_control = room.data();
    message.msg_controllen = CMSG_SPACE(size);
    auto* part = CMSG_FIRSTHDR(&message);
    part->cmsg_level = SOL_SOCKET;
    part->cmsg_type = SCM_RIGHTS;
    part->cmsg_len = CMSG_LEN(size);
    std::memcpy(CMSG_DATA(part), descriptors.data(), size);
  }
  const auto sent = sendmsg(client.socket.get(), &message, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent < 0) return errno == EAGAIN && descriptors.empty();
  client.unsent.erase(0, static_cast<std::size_t>(sent));
  return true;
}

void ControlServer::send_rest(std::uint64_t id) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  if (!send_some(found->second, {})) return drop(id);
  if (found->second.unsent.empty()) loop_.watch_writing(found->second.socket.get(), {});
}

void ControlServer::drop(std::uint64_t id) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  loop_.forget(found->second.socket.get());
  clients_.erase(found);
}

}  // namespace handcast::supervisor
