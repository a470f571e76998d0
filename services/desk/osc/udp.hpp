// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "services/desk/osc/packet.hpp"

namespace handcast::desk::osc {

/// The kinds of sockets.
enum class Transport { udp, tcp };

/// A socket that does not block, bound to "127.0.0.1:9000" (or a name, or "[::1]:9000").
/// `setting`: where the address stands. `port`: instead of that of the address, if not negative.
/// Errors: bad_config (no address), unavailable (it is in use, or not of this computer).
Result<UniqueFd> bind_socket(std::string_view address, Transport transport,
                             std::string_view setting, int port = -1);
/// The port that a socket is bound to.
int port_of(const UniqueFd& socket);
/// The host at the other end of a connected socket: "10.0.0.7"; "" if it has none.
std::string peer_of(const UniqueFd& socket);
/// A UDP socket that sends to an address. Errors: as bind_socket().
Result<UniqueFd> connect_socket(std::string_view address, std::string_view setting);

/// A datagram; refers to the memory of its DatagramReader.
struct Datagram {
  Bytes bytes;
  std::string_view from;  ///< "10.0.0.7"
  bool is_whole = true;   ///< false: it was longer than kMostDatagram
};

/// Reads many datagrams by one call. One thread.
class DatagramReader {
 public:
  /// Longer datagrams are refused: neither a controller nor a bundle of a cue comes near.
  static constexpr std::size_t kMostDatagram = 16384;
  static constexpr std::size_t kBatch = 32;

  /// The next datagrams of a socket, at most kBatch; none if none has come. Valid until the next
  /// call.
  const std::vector<Datagram>& read(const UniqueFd& socket);

 private:
  std::vector<std::array<std::uint8_t, kMostDatagram>> memory_{kBatch};
  std::array<std::array<char, 64>, kBatch> names_{};
  std::array<sockaddr_storage, kBatch> senders_{};  ///< those that names_ are of
  std::vector<Datagram> datagrams_;
};

}  // namespace handcast::desk::osc
