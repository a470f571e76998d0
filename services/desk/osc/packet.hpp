// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

/// Packets of Open Sound Control 1.0 (opensoundcontrol.org/spec-1_0), read without memory of their
/// own and without trust: each length is checked against the bytes that are there.
namespace handcast::desk::osc {

using Bytes = std::span<const std::uint8_t>;

inline constexpr std::size_t kMostArguments = 64;  ///< of one message that is read
inline constexpr std::size_t kMostPacket = 65507;  ///< bytes: the largest datagram of UDP over IPv4
inline constexpr std::uint64_t kAtOnce = 1;        ///< the time tag "immediately"

/// One argument of a message.
struct Argument {
  char type = 'N';        ///< i h f d s S T F N I, or another type of the specification
  double number = 0;      ///< i, h, f, d; T: 1, F: 0
  std::string_view text;  ///< s, S

  bool is_number() const { return std::string_view("ihfdTF").find(type) != std::string_view::npos; }
  bool is_text() const { return type == 's' || type == 'S'; }
};

/// A message that was read; refers to the bytes of its packet.
struct Message {
  std::string_view address;
  std::array<Argument, kMostArguments> all{};
  std::size_t count = 0;

  std::span<const Argument> arguments() const { return std::span(all).first(count); }
};

/// A bundle that was read; refers to the bytes of its packet.
struct Bundle {
  std::uint64_t time_tag = kAtOnce;  ///< NTP: seconds since 1900 in the upper half
  std::vector<Bytes> elements;       ///< packets
};

/// True if the packet is meant as a bundle; otherwise it is a message.
bool is_bundle(Bytes packet);
/// Reads a message or a bundle. Errors: bad_data (a sentence).
/// @{
Result<Message> read_message(Bytes packet);
Result<Bundle> read_bundle(Bytes packet);
/// @}

/// Writes one message.
class MessageWriter {
 public:
  explicit MessageWriter(std::string_view address) { put_text(packet_, address); }

  /// Adds an argument: f, i, s, T or F.
  /// @{
  MessageWriter& add(float number);
  MessageWriter& add(std::int32_t number);
  MessageWriter& add(std::string_view text);
  MessageWriter& add(bool flag);
  /// @}
  MessageWriter& add(const char* text) { return add(std::string_view(text)); }

  /// The bytes of the message.
  std::string packet() const;

 private:
  static void put_text(std::string& bytes, std::string_view text);

  std::string packet_;       ///< the address
  std::string types_ = ",";  ///< the type tags
  std::string arguments_;
};

/// The bytes of a bundle for "immediately".
std::string write_bundle(std::span<const std::string> packets);

}  // namespace handcast::desk::osc
