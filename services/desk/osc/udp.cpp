// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/udp.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "ipc/base/quote.hpp"

namespace handcast::desk::osc {
namespace {

using Found = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

Result<Found> look_up(std::string_view address, Transport transport, std::string_view setting,
                      int port) {
  const auto colon = address.rfind(':');
  auto host = address.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const auto number = colon == address.npos ? "" : std::string(address.substr(colon + 1));
  const auto wrong = [&](std::string_view why) {
    return fail(Errc::bad_config,
                fmt::format("{}: {} {}; write an address and a port, e.g. \"127.0.0.1:9000\"",
                            setting, quote(address), why));
  };
  if (colon == address.npos || host.empty() || number.empty())
    return wrong("is no address with a port");
  addrinfo hints{};
  hints.ai_socktype = transport == Transport::udp ? SOCK_DGRAM : SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const auto service = port >= 0 ? std::to_string(port) : number;
  if (const int error = ::getaddrinfo(std::string(host).c_str(), service.c_str(), &hints, &found))
    return wrong(fmt::format("is not known ({})", ::gai_strerror(error)));
  return Found(found, &::freeaddrinfo);
}

/// A socket for the first address that was found.
Result<UniqueFd> open_socket(const addrinfo& found, std::string_view setting) {
  UniqueFd socket(::socket(found.ai_family, found.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket)
    return fail(Errc::unavailable, fmt::format("{}: no socket: {}", setting, ::strerror(errno)));
  return socket;
}

Result<void> check_call(int returned, std::string_view address, std::string_view setting) {
  if (returned == 0) return {};
  return fail(Errc::unavailable,
              fmt::format("{}: {} cannot be used: {}", setting, quote(address), ::strerror(errno)));
}

}  // namespace

Result<UniqueFd> bind_socket(std::string_view address, Transport transport,
                             std::string_view setting, int port) {
  const auto found = look_up(address, transport, setting, port);
  if (!found) return tl::make_unexpected(found.error());
  auto socket = open_socket(**found, setting);
  if (!socket) return socket;
  const int one = 1, memory = 1 << 20;
  if (transport == Transport::tcp) {
    ::setsockopt(socket->get(), SOL_SOCKET, SO_REUSEADDR, &one, sizeof one);
  } else {
    // A burst between two reads fits. The system may give less.
    ::setsockopt(socket->get(), SOL_SOCKET, SO_RCVBUF, &memory, sizeof memory);
  }
  const auto bound =
      check_call(::bind(socket->get(), (*found)->ai_addr, (*found)->ai_addrlen), address, setting);
  if (!bound) return tl::make_unexpected(bound.error());
  if (transport == Transport::tcp)
    if (const auto heard = check_call(::listen(socket->get(), 16), address, setting); !heard)
      return tl::make_unexpected(heard.error());
  return socket;
}

int port_of(const UniqueFd& socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  // IPv6 has the port at the same place.
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

Result<UniqueFd> connect_socket(std::string_view address, std::string_view setting) {
  const auto found = look_up(address, Transport::udp, setting, -1);
  if (!found) return tl::make_unexpected(found.error());
  auto socket = open_socket(**found, setting);
  if (!socket) return socket;
  const auto connected = check_call(
      ::connect(socket->get(), (*found)->ai_addr, (*found)->ai_addrlen), address, setting);
  if (!connected) return tl::make_unexpected(connected.error());
  return socket;
}

std::string peer_of(const UniqueFd& socket) {
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  std::array<char, 64> host{};
  auto* const generic = reinterpret_cast<sockaddr*>(&peer);
  if (::getpeername(socket.get(), generic, &size) != 0 ||
      ::getnameinfo(generic, size, host.data(), host.size(), nullptr, 0, NI_NUMERICHOST) != 0)
    return "";
  return host.data();
}

const std::vector<Datagram>& DatagramReader::read(const UniqueFd& socket) {
  std::array<mmsghdr, kBatch> headers{};
  std::array<iovec, kBatch> places{};
  std::array<sockaddr_storage, kBatch> senders{};
  for (std::size_t i = 0; i < kBatch; ++i) {
    places[i] = {memory_[i].data(), memory_[i].size()};
    headers[i].msg_hdr = {&senders[i], sizeof senders[i], &places[i], 1, nullptr, 0, 0};
  }
  datagrams_.clear();
  const int count = ::recvmmsg(socket.get(), headers.data(), kBatch, MSG_DONTWAIT, nullptr);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    auto& name = names_[at];
    const auto size = headers[at].msg_hdr.msg_namelen;
    // Most come from one sender.
    if (std::memcmp(&senders[at], &senders_[at], size) != 0) {
      senders_[at] = senders[at];
      ::getnameinfo(reinterpret_cast<const sockaddr*>(&senders[at]), size, name.data(), name.size(),
                    nullptr, 0, NI_NUMERICHOST);
    }
    datagrams_.push_back({Bytes(memory_[at]).first(headers[at].msg_len), name.data(),
                          (headers[at].msg_hdr.msg_flags & MSG_TRUNC) == 0});
  }
  return datagrams_;
}

}  // namespace handcast::desk::osc
