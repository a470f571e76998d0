// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace handcast::landmarks::onnx {

/// A part of a file in memory.
using Bytes = std::span<const std::uint8_t>;

/// One field of a message in protobuf's wire format.
struct Field {
  std::uint32_t number = 0;  ///< number of the field
  std::uint64_t value = 0;   ///< of a varint or a fixed-size number
  Bytes bytes;               ///< of a string, a message or a packed list
  bool is_bytes = false;     ///< `bytes` is set, not `value`

  /// The bytes as text.
  std::string text() const { return {bytes.begin(), bytes.end()}; }
  /// The value as a signed number.
  std::int64_t integer() const { return static_cast<std::int64_t>(value); }
  /// The value as a float.
  float number32() const {
    const auto bits = static_cast<std::uint32_t>(value);
    float result;
    std::memcpy(&result, &bits, sizeof(result));
    return result;
  }
};

/// Iterates over the fields of a message. Never reads beyond its bytes, whatever they contain.
class WireReader {
 public:
  /// `bytes` must outlive the object and the fields.
  explicit WireReader(Bytes bytes) : rest_(bytes) {}

  /// The next field; empty at the end, and if the bytes are not a message: see broken().
  std::optional<Field> next();
  /// True if the bytes are not a message.
  bool broken() const { return broken_; }

  /// Reads one varint without a key: an element of a packed list.
  std::optional<std::uint64_t> varint();
  /// True if all bytes have been read.
  bool at_end() const { return rest_.empty(); }

 private:
  std::optional<std::uint64_t> fixed(std::size_t size);
  std::optional<Bytes> take(std::uint64_t size);

  Bytes rest_;
  bool broken_ = false;
};

/// Writes a message by appending fields.
class WireWriter {
 public:
  /// Appends a varint.
  void varint(std::uint32_t field, std::uint64_t value);
  /// Appends a float.
  void number32(std::uint32_t field, float value);
  /// Appends bytes.
  void bytes(std::uint32_t field, Bytes content);
  /// Appends a string.
  void text(std::uint32_t field, const std::string& content);
  /// Appends a message as a field of this one.
  void message(std::uint32_t field, const WireWriter& content) { bytes(field, content.bytes_); }

  /// The bytes of the message.
  std::vector<std::uint8_t> take() && { return std::move(bytes_); }

 private:
  void raw_varint(std::uint64_t value);
  void key(std::uint32_t field, unsigned wire) { raw_varint(std::uint64_t{field} << 3 | wire); }

  std::vector<std::uint8_t> bytes_;
};

}  // namespace handcast::landmarks::onnx
