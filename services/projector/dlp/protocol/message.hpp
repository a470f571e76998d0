// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/projector/dlp/protocol/command.hpp"

// A message is a header of 4 bytes (flags, sequence number, length in 2 bytes), and, from the host,
// the command in 2 bytes, then data. All numbers have their lowest byte first. The length counts
// what follows the header. A message is sent in reports of 64 bytes; the second and later ones have
// no header. Source: TI DLPU010 and DLPU018, "USB Interface".
namespace handcast::dlp::protocol {

inline constexpr std::size_t kReportBytes = 64;
inline constexpr std::size_t kHeaderBytes = 4;
/// Longer replies count as damaged.
inline constexpr std::size_t kMostReplyBytes = 512;

using Bytes = std::vector<std::uint8_t>;
using Report = std::array<std::uint8_t, kReportBytes>;

/// Whether a message asks for data or brings some. Both are answered.
enum class Direction { read, write };

/// The reports of a message, without report numbers. `data`: at most 65533 bytes.
std::vector<Report> encode(Command command, Direction direction, std::uint8_t sequence,
                           std::span<const std::uint8_t> data = {});

/// The answer to a message.
struct Reply {
  bool refused = false;  ///< the controller does not know the command, or cannot carry it out
  Bytes data;
};

/// Puts the reply to one message together from input reports. Replies with other sequence numbers,
/// which belong to messages that were given up, are passed over. One thread.
class ReplyReader {
 public:
  explicit ReplyReader(std::uint8_t sequence) : sequence_(sequence) {}

  /// Takes the next report. Returns the reply when it is complete. Errors: bad_data (a report is
  /// too short, a reply is too long); the reply cannot be completed then.
  Result<std::optional<Reply>> take(std::span<const std::uint8_t> report);

  /// Number of replies to other messages.
  int strays() const { return strays_; }

 private:
  Result<void> begin(std::span<const std::uint8_t> report);

  std::uint8_t sequence_;
  std::size_t missing_ = 0;  ///< bytes of the present reply that are still to come
  bool is_stray_ = false;    ///< the present reply belongs to another message
  int strays_ = 0;
  Reply reply_;
};

}  // namespace handcast::dlp::protocol
