// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/inference/onnx/wire.hpp"

namespace handcast::landmarks::onnx {

namespace {
enum Wire : unsigned {
  kVarint = 0,
  kFixed64 = 1,
  kBytes = 2,
  kFixed32 = 5
};  // groups (3, 4) are not used by ONNX
}

std::optional<std::uint64_t> WireReader::varint() {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < 10 && i < rest_.size(); ++i) {
    value |= std::uint64_t{rest_[i] & 0x7fu} << (7 * i);
    if (rest_[i] < 0x80) {
      rest_ = rest_.subspan(i + 1);
      return value;
    }
  }
  broken_ = true;
  return std::nullopt;
}

std::optional<Bytes> WireReader::take(std::uint64_t size) {
  if (size > rest_.size()) {
    broken_ = true;
    return std::nullopt;
  }
  const Bytes taken = rest_.first(size);
  rest_ = rest_.subspan(size);
  return taken;
}

std::optional<std::uint64_t> WireReader::fixed(std::size_t size) {
  const auto taken = take(size);
  if (!taken) return std::nullopt;
  std::uint64_t value = 0;
  std::memcpy(&value, taken->data(), size);
  return value;
}

std::optional<Field> WireReader::next() {
  if (broken_ || rest_.empty()) return std::nullopt;
  const auto key = varint();
  if (!key) return std::nullopt;
  Field field{.number = static_cast<std::uint32_t>(*key >> 3)};
  std::optional<std::uint64_t> value;
  switch (*key & 7) {
    case kVarint:
      value = varint();
      break;
    case kFixed64:
      value = fixed(8);
      break;
    case kFixed32:
      value = fixed(4);
      break;
    case kBytes: {
      value = varint();
      const auto content = value ? take(*value) : std::nullopt;
      if (!content) return std::nullopt;
      field.bytes = *content;
      field.is_bytes = true;
      break;
    }
    default:
      broken_ = true;
  }
  if (!value) return std::nullopt;
  field.value = *value;
  return field;
}

void WireWriter::raw_varint(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<std::uint8_t>(value | 0x80));
  bytes_.push_back(static_cast<std::uint8_t>(value));
}

void WireWriter::varint(std::uint32_t field, std::uint64_t value) {
  key(field, kVarint);
  raw_varint(value);
}

void WireWriter::number32(std::uint32_t field, float value) {
  key(field, kFixed32);
  std::uint8_t bits[4];
  std::memcpy(bits, &value, 4);
  bytes_.insert(bytes_.end(), bits, bits + 4);
}

void WireWriter::bytes(std::uint32_t field, Bytes content) {
  key(field, kBytes);
  raw_varint(content.size());
  bytes_.insert(bytes_.end(), content.begin(), content.end());
}

void WireWriter::text(std::uint32_t field, const std::string& content) {
  bytes(field, {reinterpret_cast<const std::uint8_t*>(content.data()), content.size()});
}

}  // namespace handcast::landmarks::onnx
