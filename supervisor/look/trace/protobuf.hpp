// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace handcast::supervisor {

/// Encodes a protobuf message (protobuf.dev, "Encoding"). Fields are written in the order in which
/// they are added.
class Protobuf {
 public:
  /// Adds a field: a varint, a fixed64, a double, a string, or a nested message. Returns this
  /// object.
  /// @{
  Protobuf& number(std::uint32_t field, std::uint64_t value) {
    tag(field, kVarint);
    varint(value);
    return *this;
  }
  Protobuf& fixed64(std::uint32_t field, std::uint64_t value) {
    tag(field, kFixed64);
    for (int byte = 0; byte < 8; ++byte) bytes_.push_back(static_cast<char>(value >> (8 * byte)));
    return *this;
  }
  Protobuf& real(std::uint32_t field, double value) {
    return fixed64(field, std::bit_cast<std::uint64_t>(value));
  }
  Protobuf& text(std::uint32_t field, std::string_view value) {
    tag(field, kLengthDelimited);
    varint(value.size());
    bytes_.append(value);
    return *this;
  }
  Protobuf& message(std::uint32_t field, const Protobuf& value) {
    return text(field, value.bytes_);
  }
  /// @}

  /// The encoded message so far.
  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::uint32_t kVarint = 0, kFixed64 = 1, kLengthDelimited = 2;

  void tag(std::uint32_t field, std::uint32_t wire_type) {
    varint(std::uint64_t{field} << 3 | wire_type);
  }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<char>(value | 0x80));
    bytes_.push_back(static_cast<char>(value));
  }

  std::string bytes_;
};

}  // namespace handcast::supervisor
